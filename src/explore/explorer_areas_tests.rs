//! Regions and no-go areas that hold, with a robot that jumps.

use super::teleporter::{Teleporter, point_robot};
use super::{HOUSE, *};
use crate::explore::{Areas, CandidateStatus};
use crate::geometry::{Path, Polygon};
use crate::planning::{GlobalPlanner, PlanError};

fn area(x: (f64, f64), y: (f64, f64)) -> Polygon {
    Polygon::try_from(vec![[x.0, y.0], [x.1, y.0], [x.1, y.1], [x.0, y.1]]).unwrap()
}

/// The left room of the house, with the wall that ends it.
fn left_room() -> Areas {
    Areas { region: Some(area((0.0, 7.2), (0.0, 9.0))), no_go: Vec::new() }
}

pub fn explorer(areas: &Areas) -> Explorer {
    let Areas { region, no_go } = areas.clone();
    let turns = TurnSettings { at_start: false, ..TurnSettings::default() };
    Explorer::new(ExplorerSettings { region, no_go, turns, ..ExplorerSettings::default() }, &point_robot()).unwrap()
}

/// Follows to the end; every goal with the way to it.
fn explore(robot: &mut Teleporter, explorer: &mut Explorer) -> (End, Vec<(Pose, Path)>) {
    let mut goals = Vec::new();
    for _ in 0..2000 {
        let decision = explorer.step(&robot.observation());
        robot.obey(&decision.command);
        if let (Command::Drive { goal_in_map, .. }, Some(path)) = (&decision.command, &decision.path) {
            goals.push((*goal_in_map, Path::clone(path)));
        }
        if let Some(end) = decision.end {
            return (end, goals);
        }
    }
    panic!("the run did not end");
}

#[test]
fn no_goal_and_no_way_leaves_the_region() {
    let mut robot = Teleporter::new(HOUSE, 2.5, 2.5);
    let areas = left_room();
    let (end, goals) = explore(&mut robot, &mut explorer(&areas));
    assert_eq!(end.reason, EndReason::OutsideRegion, "{}", end.message);
    assert!(end.left_behind.outside_region > 0 && goals.len() > 1);
    for (goal, path) in goals {
        assert!(areas.contain(goal.position()), "{goal:?}");
        assert!(path.poses.iter().all(|pose| areas.contain(pose.position())), "{path:?}");
    }
    let inside = (1..7).flat_map(|x| (1..8).map(move |y| Cell::new(x, y)));
    let unknown = inside.filter(|&cell| robot.map.get(cell) == Some(OccupancyGrid::UNKNOWN)).count();
    assert_eq!(unknown, 0, "and all of it is explored");
}

/// The door between the rooms lies outside, the corridor inside.
#[test]
fn ways_keep_to_a_region_that_leads_round() {
    let notched = [[0., 0.], [17., 0.], [17., 9.], [8.1, 9.], [8.1, 3.1], [6.9, 3.1], [6.9, 9.], [0., 9.]];
    let areas = Areas { region: Some(Polygon::try_from(notched.to_vec()).unwrap()), no_go: Vec::new() };
    let mut robot = Teleporter::new(HOUSE, 2.5, 4.5);
    robot.map = robot.world.clone();
    for index in 0..robot.map.info().len() {
        let cell = robot.map.info().cell(index);
        if cell.x > 12 {
            robot.map.set(cell, OccupancyGrid::UNKNOWN);
        }
    }
    let (end, goals) = explore(&mut robot, &mut explorer(&areas));
    assert_eq!(end.reason, EndReason::Complete, "{}", end.message);
    let ways: Vec<Pose> = goals.iter().flat_map(|(_, path)| path.poses.clone()).collect();
    assert!(ways.iter().all(|pose| areas.contain(pose.position())), "{ways:?}");
    assert!(ways.iter().any(|pose| pose.x > 9.0), "{ways:?}");
}

#[test]
fn a_frontier_that_crosses_the_rim_counts_by_its_inside() {
    let hall = format!("{}\n{}", "?".repeat(15), format!("{}\n", ".".repeat(15)).repeat(4));
    let mut robot = Teleporter::new(hall.trim_end(), 2.5, 1.5);
    robot.map = robot.world.clone();
    let areas = Areas { region: Some(area((-1.0, 6.0), (-1.0, 9.0))), no_go: Vec::new() };
    let mut explorer = explorer(&areas);
    let record = (0..5).find_map(|_| explorer.step(&robot.observation()).record).unwrap();
    let of = |status: CandidateStatus| record.candidates.iter().find(|c| c.status == status);
    let (chosen, outside) = (of(CandidateStatus::Chosen).unwrap(), of(CandidateStatus::OutsideRegion).unwrap());
    assert_eq!((chosen.size_cells, outside.size_cells), (6, 9));
    assert!(chosen.target.x < 6.0 && record.goal.unwrap().x < 6.0);
}

#[test]
fn a_robot_outside_its_region_gets_in_and_says_so_once() {
    let mut robot = Teleporter::new(HOUSE, 10.5, 4.5);
    robot.map = robot.world.clone();
    for index in 0..robot.map.info().len() {
        let cell = robot.map.info().cell(index);
        if cell.x < 4 {
            robot.map.set(cell, OccupancyGrid::UNKNOWN);
        }
    }
    robot.stride_m = Some(0.5);
    let mut explorer = explorer(&left_room());
    explorer.settings.goal.reconsider_period_s = Some(1.0);
    let mut notices = Vec::new();
    for _ in 0..200 {
        let decision = explorer.step(&robot.observation());
        robot.obey(&decision.command);
        notices.extend(decision.notice);
        if let Command::Drive { goal_in_map, .. } = decision.command {
            assert!(left_room().contain(goal_in_map.position()), "{goal_in_map:?}");
        }
        if let Some(end) = decision.end {
            assert_eq!((end.reason, end.left_behind.frontiers), (EndReason::Complete, 0), "{}", end.message);
            break;
        }
    }
    assert!(left_room().contain(robot.pose.position()), "{:?}", robot.pose);
    let told = notices.iter().filter(|text| text.contains("outside of its region and drives in")).count();
    assert_eq!(told, 1, "{notices:?}");
}

#[test]
fn a_region_to_which_no_way_is_known_is_not_explored() {
    let mut robot = Teleporter::new("#########\n#...#...#\n#########", 1.5, 1.5);
    let beyond = Areas { region: Some(area((5.0, 8.0), (0.0, 3.0))), no_go: Vec::new() };
    let mut explorer = explorer(&beyond);
    let (end, _) = explore(&mut robot, &mut explorer);
    assert_eq!((end.reason, explorer.counts().recoveries), (EndReason::AllUnreachable, 2));
    assert!(end.message.contains("no known way leads in"), "{}", end.message);
}

/// The corridor below and the door above lead to the right room.
#[test]
fn a_no_go_area_with_a_way_round_is_gone_round() {
    let no_go = vec![area((7.0, 9.0), (3.5, 5.5))];
    let areas = Areas { region: None, no_go };
    let mut robot = Teleporter::new(HOUSE, 2.5, 4.5);
    let (end, goals) = explore(&mut robot, &mut explorer(&areas));
    assert_eq!(end.reason, EndReason::Complete, "{}", end.message);
    let ways = goals.iter().flat_map(|(_, path)| &path.poses);
    assert!(ways.clone().all(|pose| areas.contain(pose.position())));
    assert!(goals.iter().any(|(goal, _)| goal.x > 9.0), "the right room was entered: {goals:?}");
}

#[test]
fn what_lies_beyond_a_no_go_area_is_named() {
    // A hall whose middle must not be entered; its lidar sees three cells far.
    let hall = format!("{0}\n#{1}#\n{0}", "#".repeat(22), ".".repeat(20));
    let mut robot = Teleporter::new(&hall, 3.5, 1.5);
    let areas = Areas { region: None, no_go: vec![area((8.0, 9.0), (0.0, 3.0))] };
    let mut strict = explorer(&areas);
    strict.settings.goal.search_radius_m = 1.0;
    let (end, goals) = explore(&mut robot, &mut strict);
    assert!(goals.iter().all(|(goal, _)| goal.x < 8.0));
    assert_eq!(end.reason, EndReason::OutsideRegion, "{}", end.message);
    assert!(end.message.contains("beyond what these forbid (1)"), "{}", end.message);
    assert_eq!(end.left_behind.unreachable, 1);
}

#[test]
fn new_areas_take_the_goal_away_at_once_and_blame_nobody() {
    let mut robot = Teleporter::new(HOUSE, 2.5, 4.5);
    robot.stride_m = Some(0.2);
    let mut explorer = explorer(&Areas::default());
    let goal = (0..50).find_map(|_| {
        let decision = explorer.step(&robot.observation());
        robot.obey(&decision.command);
        explorer.goal()
    });
    let goal = goal.unwrap();
    let (x, y) = (goal.x, goal.y);
    explorer.set_areas(Areas { region: None, no_go: vec![area((x - 1.2, x + 1.2), (y - 1.2, y + 1.2))] });
    let decision = explorer.step(&robot.observation());
    assert!(decision.record.is_some(), "it is decided anew");
    assert!(explorer.goal().is_none_or(|new| !explorer.areas().is_in_no_go(new.position())));
    assert!(explorer.blacklisted().is_empty() && explorer.counts().goals_failed == 0);
}

/// Leads straight on, whatever is in the way.
struct Straight;

impl GlobalPlanner for Straight {
    fn name(&self) -> &'static str {
        "straight"
    }

    fn plan(&mut self, _: &crate::grid::Costmap, start: &Pose, goal: &Pose) -> Result<Path, PlanError> {
        Ok(Path { poses: vec![*start, *goal], cost: 1.0 })
    }
}

#[test]
fn a_plan_that_leads_through_a_no_go_area_is_a_no() {
    let open = format!("{0}\n{1}{0}", "?".repeat(15), format!("{}\n", ".".repeat(15)).repeat(5));
    let areas = Areas { region: None, no_go: vec![area((5.0, 6.0), (1.0, 5.0))] };
    let mut robot = Teleporter::new(&open, 3.5, 3.5);
    robot.map = robot.world.clone();
    let mut explorer = explorer(&areas);
    explorer.set_planner(Box::new(Straight));
    let record = (0..5).find_map(|_| explorer.step(&robot.observation()).record).unwrap();
    let path = |goal: Pose| {
        (1..100).map(move |i| robot.pose.position() + (goal.position() - robot.pose.position()) * f64::from(i) / 100.0)
    };
    for candidate in &record.candidates {
        let crosses = candidate.goal.is_some_and(|goal| path(goal).any(|point| areas.is_in_no_go(point)));
        assert!(!(crosses && candidate.status == CandidateStatus::Chosen), "{candidate:?}");
    }
}
