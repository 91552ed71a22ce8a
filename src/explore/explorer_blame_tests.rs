//! Failures that are none, and what is said and done about those that are.

use super::areas::explorer;
use super::teleporter::Teleporter;
use super::{HOUSE, *};
use crate::explore::Areas;
use crate::robot::{Navigation, NavigationState};

/// An explorer under way to a goal.
fn under_way() -> (Teleporter, Explorer) {
    let mut robot = Teleporter::new(HOUSE, 2.5, 4.5);
    robot.stride_m = Some(0.1);
    let mut explorer = explorer(&Areas::default());
    while explorer.goal().is_none() {
        let decision = explorer.step(&robot.observation());
        robot.obey(&decision.command);
    }
    (robot, explorer)
}

#[test]
fn a_goal_that_somebody_else_takes_away_is_no_failure() {
    for state in [NavigationState::Preempted, NavigationState::Unavailable("nobody drives".to_owned())] {
        let (mut robot, mut explorer) = under_way();
        for _ in 0..10 {
            robot.navigation.state = state.clone();
            let decision = explorer.step(&robot.observation());
            robot.obey(&decision.command);
        }
        assert!(explorer.blacklisted().is_empty() && explorer.counts().goals_failed == 0, "{state:?}");
    }
}

#[test]
fn a_rest_is_no_failure() {
    let (mut robot, mut explorer) = under_way();
    let goal = explorer.goal();
    // The node holds the robot, and time stands still.
    robot.navigation = Navigation { command: 0, state: NavigationState::Idle };
    let decision = explorer.step(&robot.observation());
    robot.obey(&decision.command);
    assert_eq!(explorer.goal(), goal);
    assert!(explorer.blacklisted().is_empty());
}

#[test]
fn a_look_round_that_is_taken_away_says_nothing() {
    let look = |state: NavigationState| {
        let mut robot = Teleporter::new(HOUSE, 2.5, 4.5);
        let mut explorer = explorer(&Areas::default());
        let mut observation = robot.observation();
        explorer.step(&observation);
        observation.navigation = Navigation { command: 7, state };
        explorer.look_is_over(Point::new(3.5, 4.5), robot.pose, &observation, 7);
        explorer.look_is_over(Point::new(3.5, 4.5), robot.pose, &observation, 7);
        let is_spent = explorer.blacklist.is_spent(robot.pose.position(), Point::new(3.5, 4.5), true);
        (is_spent, explorer.blacklisted().into_iter().map(|one| one.why).collect::<Vec<_>>())
    };
    let why = "the look round was not made: no room".to_owned();
    assert_eq!(look(NavigationState::Preempted), (false, Vec::new()));
    assert_eq!(look(NavigationState::Succeeded), (true, Vec::new()));
    assert_eq!(look(NavigationState::Aborted("no room".to_owned())), (false, vec![why]));
}

#[test]
fn what_failed_is_listed_with_its_reason_and_cleared_on_demand() {
    let (mut robot, mut explorer) = under_way();
    let goal = explorer.goal().unwrap();
    robot.navigation.state = NavigationState::Aborted("a cat in the way".to_owned());
    explorer.step(&robot.observation());
    let listed = explorer.blacklisted();
    assert_eq!((listed.len(), listed[0].failures, listed[0].is_left_alone), (1, 1, false));
    assert_eq!((listed[0].why.as_str(), listed[0].place), ("a cat in the way", goal.position()));
    assert_eq!(explorer.clear_blacklist(), 1);
    assert!(explorer.blacklisted().is_empty() && explorer.clear_blacklist() == 0);
}

#[test]
fn a_door_that_opens_is_tried_again_in_the_same_round() {
    let (mut robot, mut explorer) = under_way();
    let goal = explorer.goal().unwrap();
    explorer.settings.goal.reconsider_period_s = Some(1.0);
    robot.navigation.state = NavigationState::Aborted("a shut door".to_owned());
    robot.pose = Pose::new(goal.x - 1.0, goal.y, 0.0);
    // Beside it is a wall on the map of the failure.
    let at = robot.map.info().cell_at(goal.position());
    for (dx, dy) in [(1, 0), (1, 1), (1, -1)] {
        robot.world.set(at.offset((dx, dy)), 100);
    }
    explorer.step(&robot.observation());
    assert_eq!(explorer.blacklisted().len(), 1);
    for (dx, dy) in [(1, 0), (1, 1), (1, -1)] {
        robot.world.set(at.offset((dx, dy)), 0);
    }
    let decision = explorer.step(&robot.observation());
    robot.obey(&decision.command);
    let decision = explorer.step(&robot.observation());
    let notices = [decision.notice, explorer.notice.take()];
    assert!(explorer.blacklisted().is_empty(), "{:?} {notices:?}", explorer.blacklisted());
}
