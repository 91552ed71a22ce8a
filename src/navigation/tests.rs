//! The navigator on costmaps drawn by hand, with a perfect body.

use super::*;
use crate::control::{FollowerConfig, PathFollower};
use crate::geometry::{Body, Footprint, MotionLimits, Pose, shortest_angle};
use crate::grid::{Cell, GridInfo};
use crate::planning::{Astar, PlanError};

const LIMITS: MotionLimits =
    MotionLimits { max_linear_mps: 0.5, max_angular_rps: 2.0, max_linear_mps2: 1.0, max_angular_rps2: 4.0 };

/// An open square of 10 m, with the given cells blocked.
fn costmap(blocked: impl Fn(Cell) -> bool) -> Arc<Costmap> {
    let info = GridInfo::new(100, 100, 0.1, Pose::default()).unwrap();
    let costs = (0..info.len()).map(|i| if blocked(info.cell(i)) { 254 } else { 0 }).collect();
    Arc::new(Costmap::from_costs(info, costs).unwrap())
}

fn navigator() -> Navigator {
    let body = Body { footprint: Footprint::RadiusM(0.18), limits: LIMITS };
    let follower = PathFollower::new(FollowerConfig::default(), body.clone());
    Navigator::new(NavigatorConfig::default(), Box::new(Astar::default()), Box::new(follower), &body)
}

/// Runs until the command has ended; the costmap may change with time.
fn run(command: &Command, start: Pose, map_at: impl Fn(f64) -> Arc<Costmap>) -> (Pose, NavigationState, f64) {
    let mut navigator = navigator();
    navigator.command(command);
    let (mut pose, mut twist) = (start, Twist::ZERO);
    for tick in 0..1000 {
        let stamp_s = f64::from(tick) * 0.1;
        let costmap = map_at(stamp_s);
        let input = NavigationInput {
            stamp_s,
            pose_in_map: pose,
            twist,
            costmap: &costmap,
            costmap_stamp_s: stamp_s.floor(),
            scan: None,
        };
        navigator.command(command);
        let (wanted, navigation) = navigator.update(&input);
        assert_eq!(navigation.command, 1);
        if navigation.state != NavigationState::Active {
            return (pose, navigation.state, stamp_s);
        }
        twist = LIMITS.reachable(&twist, &wanted, 0.1);
        pose = twist.advance(&pose, 0.1);
    }
    panic!("the command did not end in 100 s");
}

#[test]
fn drives_to_a_goal_and_faces_as_told() {
    let goal = Pose::new(8.0, 8.0, -1.0);
    let (end, state, _) =
        run(&Command::Drive { id: 1, goal_in_map: goal }, Pose::new(1.0, 1.0, 3.0), |_| costmap(|_| false));
    assert_eq!(state, NavigationState::Succeeded);
    assert!(end.distance_to(goal.position()) < 0.2 && shortest_angle(end.yaw, goal.yaw).abs() < 0.35, "{end:?}");
}

#[test]
fn a_wall_that_appears_is_driven_around() {
    let goal = Pose::new(8.0, 5.0, 0.0);
    let wall = |c: Cell| c.x == 50 && c.y < 90;
    let (end, state, _) = run(&Command::Drive { id: 1, goal_in_map: goal }, Pose::new(1.0, 5.0, 0.0), |stamp| {
        costmap(|c| stamp > 3.0 && wall(c))
    });
    assert_eq!(state, NavigationState::Succeeded);
    assert!(end.distance_to(goal.position()) < 0.2);
}

#[test]
fn a_goal_without_a_path_is_aborted_with_its_reason() {
    let goal = Pose::new(8.0, 5.0, 0.0);
    let (_, state, after_s) =
        run(&Command::Drive { id: 1, goal_in_map: goal }, Pose::new(1.0, 5.0, 0.0), |_| costmap(|c| c.x == 50));
    assert_eq!(state, NavigationState::Aborted("no path leads to the goal (8.00, 5.00) m".to_owned()));
    assert!((2.0..3.0).contains(&after_s));
}

/// Plans once and gives up from then on.
struct GivesUp(Astar, bool);

impl GlobalPlanner for GivesUp {
    fn name(&self) -> &'static str {
        "gives_up"
    }

    fn plan(&mut self, costmap: &Costmap, start: &Pose, goal: &Pose) -> Result<Path, PlanError> {
        if std::mem::replace(&mut self.1, true) {
            return Err(PlanError::IterationLimit { limit: 1 });
        }
        self.0.plan(costmap, start, goal)
    }
}

#[test]
fn a_free_path_serves_on_when_the_planner_gives_up() {
    let body = Body { footprint: Footprint::RadiusM(0.18), limits: LIMITS };
    let follower = PathFollower::new(FollowerConfig::default(), body.clone());
    let planner = GivesUp(Astar::default(), false);
    let mut navigator = Navigator::new(NavigatorConfig::default(), Box::new(planner), Box::new(follower), &body);
    navigator.command(&Command::Drive { id: 1, goal_in_map: Pose::new(8.0, 5.0, 0.0) });
    let input = |stamp_s, costmap| NavigationInput {
        stamp_s,
        pose_in_map: Pose::new(1.0, 5.0, 0.0),
        twist: Twist::ZERO,
        costmap,
        costmap_stamp_s: stamp_s,
        scan: None,
    };
    let (open, walled) = (costmap(|_| false), costmap(|c| c.x == 50));
    for stamp_s in [0.0, 3.0, 6.0, 9.0] {
        assert_eq!(navigator.update(&input(stamp_s, &open)).1.state, NavigationState::Active);
        assert!(navigator.path().is_some(), "after {stamp_s} s");
    }
    navigator.update(&input(12.0, &walled));
    assert!(navigator.path().is_none(), "a path through a wall does not serve");
}

#[test]
fn a_full_turn_takes_its_time() {
    let (end, state, after_s) =
        run(&Command::Turn { id: 1, angle_rad: std::f64::consts::TAU }, Pose::new(5.0, 5.0, 1.0), |_| {
            costmap(|_| false)
        });
    assert_eq!(state, NavigationState::Succeeded);
    assert!((6.0..9.0).contains(&after_s), "{after_s}");
    assert!(end.distance_to(crate::geometry::Point::new(5.0, 5.0)) < 1e-9);
}

#[test]
fn holding_is_idle() {
    let mut navigator = navigator();
    navigator.command(&Command::Hold);
    let costmap = costmap(|_| false);
    let input = NavigationInput {
        stamp_s: 0.0,
        pose_in_map: Pose::default(),
        twist: Twist::ZERO,
        costmap: &costmap,
        costmap_stamp_s: 0.0,
        scan: None,
    };
    let (twist, navigation) = navigator.update(&input);
    assert_eq!((twist, navigation.state), (Twist::ZERO, NavigationState::Idle));
}

#[test]
fn areas_that_come_on_the_way_are_driven_round() {
    let goal = Pose::new(8.0, 5.0, 0.0);
    let corners = vec![[4.0, 2.0], [6.0, 2.0], [6.0, 7.0], [4.0, 7.0]];
    let areas = Areas { region: None, no_go: vec![crate::geometry::Polygon::try_from(corners).unwrap()] };
    let mut navigator = navigator();
    navigator.command(&Command::Drive { id: 1, goal_in_map: goal });
    let (mut pose, mut twist, open) = (Pose::new(1.0, 5.0, 0.0), Twist::ZERO, costmap(|_| false));
    for tick in 0..600 {
        if tick == 20 {
            navigator.set_areas(areas.clone());
        }
        let stamp_s = f64::from(tick) * 0.1;
        let input =
            NavigationInput { stamp_s, pose_in_map: pose, twist, costmap: &open, costmap_stamp_s: 0.0, scan: None };
        let (wanted, navigation) = navigator.update(&input);
        if navigation.state != NavigationState::Active {
            assert_eq!(navigation.state, NavigationState::Succeeded);
            return;
        }
        twist = LIMITS.reachable(&twist, &wanted, 0.1);
        pose = twist.advance(&pose, 0.1);
        assert!(areas.contain(pose.position()), "{pose:?}");
    }
    panic!("it did not arrive");
}
