//! D* Lite against A*: the same costs, and fewer expansions where little changed.

use super::*;
use crate::planning::Astar;
use proptest::prelude::*;

/// A costmap of 1 m cells with its first cell at a place in cells.
fn costmap(width: u32, origin: (i32, i32), costs: &[u8]) -> Costmap {
    let origin = Pose::new(f64::from(origin.0), f64::from(origin.1), 0.0);
    let info = GridInfo::new(width, costs.len() as u32 / width, 1.0, origin).unwrap();
    Costmap::from_costs(info, costs.to_vec()).unwrap()
}

fn center(costmap: &Costmap, index: usize) -> Pose {
    let center = costmap.info().center(costmap.info().cell(index));
    Pose::new(center.x, center.y, 0.0)
}

/// Plans with both, compares the costs, and returns how many cells D* Lite expanded.
fn check(planner: &mut DStarLite, costmap: &Costmap, start: usize, goal: usize) -> usize {
    let (start, goal) = (center(costmap, start), center(costmap, goal));
    let expected = Astar::default().plan(costmap, &start, &goal).map(|path| path.cost);
    let found = planner.plan(costmap, &start, &goal);
    if let Ok(path) = &found {
        for pair in path.poses.windows(2) {
            assert!(pair[0].distance_to(pair[1].position()) < 1.5, "{path:?}");
        }
    }
    assert_eq!(found.map(|path| path.cost), expected);
    planner.expansions()
}

/// 60 x 40 cells with a wall that has two gaps.
fn hall() -> Vec<u8> {
    let mut costs = vec![0; 60 * 40];
    for y in (0..40).filter(|y| ![5, 35].contains(y)) {
        costs[y * 60 + 30] = 254;
    }
    costs
}

#[test]
fn a_closed_gap_is_repaired_with_fewer_expansions_than_anew() {
    let (start, goal) = (8 * 60 + 20, 8 * 60 + 50);
    let mut planner = DStarLite::default();
    let mut costs = hall();
    let first = check(&mut planner, &costmap(60, (0, 0), &costs), start, goal);
    assert_eq!(check(&mut planner, &costmap(60, (0, 0), &costs), start, goal), 0, "nothing changed");
    // Something is put into the room, a little off the way.
    costs[12 * 60 + 40] = 254;
    costs[12 * 60 + 41] = 120;
    let changed = costmap(60, (0, 0), &costs);
    let repaired = check(&mut planner, &changed, start + 2, goal);
    let anew = check(&mut DStarLite::default(), &changed, start + 2, goal);
    assert!(repaired * 4 < anew, "{repaired} against {anew}, {first} at first");
    // The near gap closes: the way leads through the far one.
    costs[5 * 60 + 30] = 254;
    check(&mut planner, &costmap(60, (0, 0), &costs), start + 3, goal);
    costs[5 * 60 + 30] = 0;
    check(&mut planner, &costmap(60, (0, 0), &costs), start + 4, goal);
}

#[test]
fn a_grown_map_keeps_the_search() {
    let (start, goal) = (8 * 60 + 20, 8 * 60 + 50);
    let mut planner = DStarLite::default();
    check(&mut planner, &costmap(60, (0, 0), &hall()), start, goal);
    // Five columns more on the left, three rows more below, all unknown but a few.
    let mut grown = vec![255; 70 * 43];
    for (row, old) in hall().chunks(60).enumerate() {
        grown[(row + 3) * 70 + 5..(row + 3) * 70 + 65].copy_from_slice(old);
    }
    grown[3 * 70 + 4] = 0;
    let map = costmap(70, (-5, -3), &grown);
    let repaired = check(&mut planner, &map, (8 + 3) * 70 + 25, (8 + 3) * 70 + 55);
    let anew = check(&mut DStarLite::default(), &map, (8 + 3) * 70 + 25, (8 + 3) * 70 + 55);
    assert!(repaired * 4 < anew, "{repaired} against {anew}");
}

#[test]
fn a_shrunk_or_turned_map_begins_anew() {
    let mut planner = DStarLite::default();
    check(&mut planner, &costmap(60, (0, 0), &hall()), 8 * 60 + 20, 8 * 60 + 50);
    check(&mut planner, &costmap(10, (2, 2), &[0; 100]), 0, 99);
    let turned = GridInfo::new(10, 10, 1.0, Pose::new(2.0, 2.0, 0.5)).unwrap();
    check(&mut planner, &Costmap::from_costs(turned, vec![0; 100]).unwrap(), 0, 99);
}

/// A cost: mostly open, some high, some blocked.
fn cost() -> impl Strategy<Value = u8> {
    prop_oneof![4 => Just(0_u8), 2 => 1_u8..=252, 2 => 253_u8..=255]
}

const SIDE: usize = 16;
const CELLS: usize = SIDE * SIDE;

proptest! {
    #[test]
    fn costs_what_astar_costs_over_a_sequence_of_changes(
        mut costs in proptest::collection::vec(cost(), CELLS),
        goal in 0..CELLS,
        rounds in proptest::collection::vec(
            (0..CELLS, proptest::collection::vec((0..CELLS, cost()), 0..12)), 1..12),
        margin in 0usize..4, grow_after in 0usize..12,
    ) {
        let mut planner = DStarLite::default();
        for (round, (start, changes)) in rounds.into_iter().enumerate() {
            for (index, cost) in changes {
                costs[index] = cost;
            }
            if round < grow_after {
                check(&mut planner, &costmap(SIDE as u32, (0, 0), &costs), start, goal);
                continue;
            }
            // The same cells within a wider map.
            let width = SIDE + 2 * margin;
            let wider = |index: usize| (index / SIDE + margin) * width + index % SIDE + margin;
            let mut grown = vec![0; width * width];
            for (index, &cost) in costs.iter().enumerate() {
                grown[wider(index)] = cost;
            }
            let origin = -(margin as i32);
            check(&mut planner, &costmap(width as u32, (origin, origin), &grown), wider(start), wider(goal));
        }
    }
}
