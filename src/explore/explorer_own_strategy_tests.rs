//! A strategy that is none of ours chooses for the explorer.

use super::teleporter::{Teleporter, point_robot};
use super::{HOUSE, *};
use crate::explore::{CandidateRecord, CandidateStatus};
use crate::selection::{Candidate, GoalSelector, Score, SelectionContext};

/// Goes as far away as it can, over cells that it checks itself.
struct Farthest;

impl GoalSelector for Farthest {
    fn name(&self) -> &'static str {
        "farthest"
    }

    fn score(&mut self, candidates: &[Candidate], context: &mut SelectionContext<'_>) -> Vec<Score> {
        let ground = context.ground.as_ref().unwrap();
        let score = |candidate: &Candidate| {
            let goal = candidate.goal.position();
            let cell = ground.grid.info().cell_at(goal);
            assert_eq!(ground.grid.state(cell, &ground.thresholds), CellState::Free);
            assert!(ground.costmap.is_passable(ground.costmap.info().cell_at(goal)));
            Score { total: -context.robot_in_map.distance_to(goal), ..Score::default() }
        };
        assert!(context.now_s > 0.0 && context.sight.range_m == 3.0);
        candidates.iter().map(score).collect()
    }
}

#[test]
fn a_strategy_of_ones_own_sees_the_map_and_chooses() {
    let mut robot = Teleporter::new(HOUSE, 2.5, 2.5);
    let mut explorer = Explorer::new(ExplorerSettings::default(), &point_robot()).unwrap();
    explorer.set_selector(Box::new(Farthest));
    let mut checked = 0;
    for _ in 0..2000 {
        let decision = explorer.step(&robot.observation());
        robot.obey(&decision.command);
        if let Some(record) = decision.record.filter(|record| record.goal.is_some()) {
            let far_m = |c: &CandidateRecord| c.goal.map_or(0.0, |goal| record.pose.distance_to(goal.position()));
            let open = record.candidates.iter().filter(|c| c.status == CandidateStatus::Eligible);
            assert!(open.map(far_m).all(|other_m| other_m <= far_m(&record.candidates[0]) + 1e-9), "{record:?}");
            checked += 1;
        }
        if let Some(end) = decision.end {
            assert_eq!(end.reason, EndReason::Complete);
            assert!(checked > 3);
            return;
        }
    }
    panic!("the run did not end");
}

/// Likes another frontier best each time.
struct Fickle(usize);

impl GoalSelector for Fickle {
    fn name(&self) -> &'static str {
        "fickle"
    }

    fn keeps_goals(&self) -> bool {
        true
    }

    fn score(&mut self, candidates: &[Candidate], _: &mut SelectionContext<'_>) -> Vec<Score> {
        self.0 += 1;
        let total = |i: usize| ((i + self.0) % candidates.len()) as f64;
        (0..candidates.len()).map(|i| Score { total: total(i), ..Score::default() }).collect()
    }
}

#[test]
fn a_strategy_that_cannot_decide_is_held_to_its_goal() {
    let hall = format!("{0}\n#{1}#\n{0}", "#".repeat(42), ".".repeat(40));
    let mut robot = Teleporter::new(&hall, 20.5, 1.5);
    robot.stride_m = Some(0.4);
    let turns = TurnSettings { at_start: false, at_goal: false, recoveries: 0 };
    let mut settings = ExplorerSettings { turns, ..ExplorerSettings::default() };
    settings.goal.reconsider_period_s = Some(1.0);
    let mut explorer = Explorer::new(settings, &point_robot()).unwrap();
    explorer.set_selector(Box::new(Fickle(0)));
    let end = robot.follow(&mut explorer, 4000);
    assert_eq!(end.map(|end| end.reason), Some(EndReason::Complete));
}
