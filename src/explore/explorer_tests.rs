//! The state machine, driven by a robot that jumps to its goals.

use super::super::state::Phase;
use super::*;
use crate::explore::{PatienceSettings, TurnSettings};
use crate::geometry::Point;
use crate::grid::{Cell, CellState, OccupancyGrid, Thresholds};
use crate::planning::{HybridAstarConfig, PlannerConfig};
use crate::robot::{Command, PoseError};
use crate::scan::Sight;
use std::f64::consts::{PI, TAU};

#[path = "explorer_teleporter_tests.rs"]
mod teleporter;
use teleporter::{Teleporter, point_robot};

#[path = "explorer_adjust_tests.rs"]
mod adjusting;

#[path = "explorer_areas_tests.rs"]
mod areas;

#[path = "explorer_blame_tests.rs"]
mod blame;

#[path = "explorer_own_strategy_tests.rs"]
mod own_strategy;

/// Two rooms and a corridor, 17 x 9 m.
const HOUSE: &str = "
    #################
    #......#........#
    #......#........#
    #......#........#
    #...............#
    #......#........#
    #......####.#####
    #...............#
    #################";

#[test]
fn explores_everything_and_says_so() {
    let mut robot = Teleporter::new(HOUSE, 2.5, 2.5);
    let (end, explorer) = robot.explore(ExplorerSettings::default());
    assert_eq!(end.reason, EndReason::Complete);
    assert_eq!(end.left_behind, LeftBehind::default());
    let thresholds = Thresholds::default();
    for index in 0..robot.world.info().len() {
        let cell = robot.world.info().cell(index);
        if robot.world.state(cell, &thresholds) == CellState::Free {
            assert_eq!(robot.map.state(cell, &thresholds), CellState::Free, "{cell:?}");
        }
    }
    let counts = explorer.counts();
    assert!(counts.goals_sent >= 3 && counts.goals_reached == counts.goals_sent && counts.goals_failed == 0);
    // Topiwala 2018: a full turn at the start and at every goal.
    assert_eq!(counts.turns, counts.goals_reached + 1);
    assert!(matches!(robot.log[0], Command::Turn { id: 1, angle_rad } if angle_rad == TAU));
}

#[test]
fn without_turns_it_drives_at_once() {
    let mut robot = Teleporter::new(HOUSE, 2.5, 2.5);
    let turns = TurnSettings { at_start: false, at_goal: false, recoveries: 0 };
    let (end, explorer) = robot.explore(ExplorerSettings { turns, ..ExplorerSettings::default() });
    assert_eq!((end.reason, explorer.counts().turns), (EndReason::Complete, 0));
    assert!(robot.log.iter().all(|c| !matches!(c, Command::Turn { .. })));
}

#[test]
fn the_nearest_goal_comes_first() {
    let mut robot = Teleporter::new(HOUSE, 2.5, 2.5);
    let mut explorer = Explorer::new(ExplorerSettings::default(), &point_robot()).unwrap();
    let record = loop {
        let decision = explorer.step(&robot.observation());
        robot.obey(&decision.command);
        if let Some(record) = decision.record {
            break record;
        }
    };
    let distances: Vec<f64> = record.candidates.iter().map(|c| c.distance_m).collect();
    assert!(distances.windows(2).all(|pair| pair[0] <= pair[1]), "{distances:?}");
    assert_eq!(record.candidates[0].status, crate::explore::CandidateStatus::Chosen);
    assert!(record.why.starts_with("nearest: best of"));
}

#[test]
fn goals_that_fail_end_in_all_unreachable_after_the_recovery_turns() {
    let mut robot = Teleporter::new(HOUSE, 2.5, 2.5);
    robot.aborts = true;
    let (end, explorer) = robot.explore(ExplorerSettings::default());
    assert_eq!(end.reason, EndReason::AllUnreachable);
    assert!(end.left_behind.failed > 0 && end.left_behind.unreachable == 0);
    assert_eq!(explorer.counts().recoveries, 2);
    assert!(explorer.counts().goals_failed >= 4);
    assert!(end.time_s < 400.0, "a round without progress ends within minutes: {} s", end.time_s);
}

#[test]
fn a_robot_that_does_not_get_away_is_stuck_and_says_so() {
    let mut robot = Teleporter::new(HOUSE, 2.5, 2.5);
    (robot.aborts, robot.moves) = (true, false);
    let (end, explorer) = robot.explore(ExplorerSettings::default());
    assert_eq!(end.reason, EndReason::Stuck, "{}", end.message);
    assert!(explorer.counts().back_offs >= 1 && robot.log.iter().any(|c| matches!(c, Command::BackOff { .. })));
    assert!(end.time_s < 400.0, "{} s", end.time_s);
}

#[test]
fn a_frontier_that_stays_is_visited_twice_and_then_left() {
    // The robot never learns the cell behind the window.
    let mut robot = Teleporter::new("#####\n#...?\n#...#\n#####", 1.5, 1.5);
    let (end, explorer) = robot.explore(ExplorerSettings::default());
    assert_eq!(end.reason, EndReason::Complete);
    assert_eq!((end.left_behind.exhausted, end.left_behind.frontiers), (1, 1));
    assert!(explorer.counts().turns <= 4);
}

#[test]
fn a_look_round_that_is_not_made_shows_nothing() {
    // The frontier lies behind the robot, which stands where it would be seen from.
    let end_of = |cannot_turn| {
        let mut robot = Teleporter::new("#####\n#...?\n#...#\n#####", 3.5, 1.5);
        // Nor can it drive anywhere else.
        (robot.pose.yaw, robot.cannot_turn, robot.aborts, robot.moves) = (PI, cannot_turn, true, false);
        let turns = TurnSettings { at_start: false, at_goal: false, recoveries: 1 };
        let sight = Sight { range_m: 3.0, field_of_view_rad: 1.0, heading_rad: 0.0 };
        let settings = ExplorerSettings { turns, ..ExplorerSettings::default() };
        let mut explorer = Explorer::new(settings, &RobotTraits { sight, ..point_robot() }).unwrap();
        let end = robot.follow(&mut explorer, 2000);
        end.map(|end| (end.reason, end.left_behind.frontiers))
    };
    assert_eq!(end_of(true), Some((EndReason::Stuck, 1)));
    assert_eq!(end_of(false), Some((EndReason::Complete, 1)));
}

#[test]
fn a_robot_that_drives_on_at_once_has_been_there_all_the_same() {
    // Two windows, and a lidar that cannot look through them.
    let mut robot = Teleporter::new("#########\n?.......?\n#########", 4.5, 1.5);
    robot.stops_short = true;
    let turns = TurnSettings { at_start: false, at_goal: false, recoveries: 0 };
    let mut settings = ExplorerSettings { turns, ..ExplorerSettings::default() };
    settings.goal.reconsider_period_s = Some(1.0);
    let sight = Sight { range_m: 1.0, field_of_view_rad: TAU, heading_rad: 0.0 };
    let mut explorer = Explorer::new(settings, &RobotTraits { sight, ..point_robot() }).unwrap();
    let end = robot.follow(&mut explorer, 200);
    let end = end.expect("an end, and no driving to and fro until nothing was seen for long");
    assert_eq!((end.reason, end.left_behind.frontiers), (EndReason::Complete, 2), "{}", end.message);
}

#[test]
fn a_pose_that_is_corrected_with_each_map_puts_off_no_end() {
    let mut robot = Teleporter::new(HOUSE, 2.5, 2.5);
    robot.is_corrected = true;
    let (end, _) = robot.explore(ExplorerSettings::default());
    assert_eq!(end.reason, EndReason::Complete, "{}", end.message);
}

#[test]
fn what_lies_beside_the_way_comes_before_it() {
    const CORRIDOR: &str = "################\n#.............??\n?.............??\n#.............??\n################";
    let goal_x = |beside_way_m| {
        let mut robot = Teleporter::new(CORRIDOR, 3.5, 2.5);
        robot.map = robot.world.clone();
        let mut settings = ExplorerSettings::default();
        settings.turns.at_start = false;
        // The window to the left is too small for the preset.
        settings.detector.min_size_m = 2.0;
        settings.goal.beside_way_m = beside_way_m;
        let mut explorer = Explorer::new(settings, &point_robot()).unwrap();
        match explorer.step(&robot.observation()).command {
            Command::Drive { goal_in_map, .. } => goal_in_map.x,
            other => panic!("{other:?}"),
        }
    };
    assert!(goal_x(None) > 10.0);
    assert!(goal_x(Some(4.0)) < 3.0);
    assert!(goal_x(Some(1.0)) > 10.0, "too far to be beside the way");
}

#[test]
fn frontiers_outside_the_region_are_left() {
    let mut robot = Teleporter::new(HOUSE, 2.5, 2.5);
    let region = crate::geometry::Polygon::try_from(vec![[0.0, 0.0], [6.9, 0.0], [6.9, 9.0], [0.0, 9.0]]).unwrap();
    let (end, _) = robot.explore(ExplorerSettings { region: Some(region), ..ExplorerSettings::default() });
    assert_eq!(end.reason, EndReason::OutsideRegion);
    assert!(end.left_behind.outside_region > 0);
    assert_eq!(robot.map.get(Cell::new(14, 6)), Some(OccupancyGrid::UNKNOWN));
}

#[test]
fn returns_to_where_it_began() {
    let mut robot = Teleporter::new(HOUSE, 2.5, 2.5);
    let (end, _) = robot.explore(ExplorerSettings { return_to_start: true, ..ExplorerSettings::default() });
    assert_eq!(end.reason, EndReason::Complete);
    assert!(robot.pose.distance_to(Point::new(2.5, 2.5)) < 1e-9);
}

#[test]
fn a_lost_pose_pauses_and_ends_only_when_it_lasts() {
    let mut robot = Teleporter::new(HOUSE, 2.5, 2.5);
    let mut explorer = Explorer::new(ExplorerSettings::default(), &point_robot()).unwrap();
    let mut lost = robot.observation();
    lost.pose_in_map = Err(PoseError::NotYet {
        map_frame: "map".to_owned(),
        base_frame: "base_link".to_owned(),
        why: "no frame".to_owned(),
    });
    for tick in 0..59 {
        lost.stamp_s = f64::from(tick);
        let decision = explorer.step(&lost);
        assert_eq!((decision.phase, decision.command, decision.end), (Phase::WaitingForPose, Command::Hold, None));
    }
    lost.stamp_s = 60.0;
    assert_eq!(explorer.step(&lost).end.map(|e| e.reason), Some(EndReason::NoPose));
}

#[test]
fn no_map_and_no_time_have_their_own_ends() {
    let mut robot = Teleporter::new(HOUSE, 2.5, 2.5);
    let turns = TurnSettings { at_start: false, ..TurnSettings::default() };
    let settings = ExplorerSettings { turns, ..ExplorerSettings::default() };
    let mut explorer = Explorer::new(settings.clone(), &point_robot()).unwrap();
    let mut blind = robot.observation();
    blind.map = None;
    let mut end = None;
    for tick in 0..=61 {
        blind.stamp_s = f64::from(tick);
        end = explorer.step(&blind).end;
    }
    assert_eq!(end.map(|e| e.reason), Some(EndReason::NoMap));

    let patience = PatienceSettings { time_limit_s: Some(5.0), ..Default::default() };
    let (end, _) = robot.explore(ExplorerSettings { patience, ..settings });
    assert_eq!((end.reason, end.time_s), (EndReason::TimeLimit, end.time_s));
}

#[test]
fn a_robot_off_its_map_waits_for_a_better_one() {
    let mut robot = Teleporter::new(HOUSE, 2.5, 2.5);
    let turns = TurnSettings { at_start: false, ..TurnSettings::default() };
    let mut explorer = Explorer::new(ExplorerSettings { turns, ..Default::default() }, &point_robot()).unwrap();
    let mut off = robot.observation();
    off.pose_in_map = Ok(Pose::new(-50.0, 0.0, 0.0));
    for tick in 0..30 {
        off.stamp_s = f64::from(tick);
        let decision = explorer.step(&off);
        assert_eq!((decision.phase, decision.end), (Phase::WaitingForMap, None));
    }
    robot.stamp_s = 31.0;
    let decision = explorer.step(&robot.observation());
    assert_eq!(decision.end, None);
    assert!(decision.record.is_some(), "goes on as soon as the map serves");
}

#[test]
fn a_goal_too_far_for_the_planner_is_approached_in_stages() {
    let hybrid = HybridAstarConfig { max_expansions: 200, ..HybridAstarConfig::DEFAULT };
    let turns = TurnSettings { recoveries: 0, ..TurnSettings::default() };
    let settings =
        ExplorerSettings { planner: PlannerConfig::HybridAstar(hybrid), turns, ..ExplorerSettings::default() };
    let mut robot = Teleporter::new(HOUSE, 2.5, 2.5);
    let mut explorer = Explorer::new(settings, &point_robot()).unwrap();
    let mut stages = 0;
    for _ in 0..2000 {
        let decision = explorer.step(&robot.observation());
        robot.obey(&decision.command);
        stages += usize::from(decision.record.is_some_and(|record| record.why.contains("part of the way")));
        if let Some(end) = decision.end {
            assert_eq!(end.reason, EndReason::Complete, "{}", end.message);
            break;
        }
    }
    assert!(stages > 0);
    // No stage counts as a visit in vain, which would exhaust a frontier.
    assert_eq!(explorer.left_behind, LeftBehind::default());
}
