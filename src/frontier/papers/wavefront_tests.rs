//! The textbook detector against drawings and against a restatement of its definition.

use super::*;
use crate::frontier::random_maps::noise;
use crate::geometry::Pose;
use proptest::prelude::*;
use std::collections::BTreeSet;

fn detect(grid: &OccupancyGrid, robot: (f64, f64), params: DetectorParams) -> Vec<Frontier> {
    let input = DetectionInput::new(grid, Pose::new(robot.0, robot.1, 0.0));
    Wavefront::new(params).detect(&input).unwrap()
}

/// Cells as drawn: (column, row from below).
fn cells(frontier: &Frontier) -> Vec<(i32, i32)> {
    frontier.cells.iter().map(|c| (c.x, c.y)).collect()
}

fn params(reachability: Reachability, neighbours: Neighbourhood) -> DetectorParams {
    DetectorParams { reachability, neighbours, ..DetectorParams::default() }
}

#[test]
fn one_room_with_one_door() {
    let grid = OccupancyGrid::from_ascii(
        "######?
         #.....?
         #....#?
         ######?",
    )
    .unwrap();
    let four = detect(&grid, (1.5, 1.5), params(Reachability::WallsBlock, Neighbourhood::Four));
    assert_eq!(four.iter().map(cells).collect::<Vec<_>>(), [vec![(6, 2)]]);
    let eight = detect(&grid, (1.5, 1.5), params(Reachability::WallsBlock, Neighbourhood::Eight));
    assert_eq!(eight.iter().map(cells).collect::<Vec<_>>(), [vec![(6, 1), (6, 2), (6, 3)]]);
}

#[test]
fn the_textbook_leaks_through_a_thin_wall_and_walls_block_does_not() {
    let grid = OccupancyGrid::from_ascii(
        "#######
         #..#..?
         #..#..?
         #######",
    )
    .unwrap();
    let leak = detect(&grid, (1.5, 1.5), params(Reachability::Textbook, Neighbourhood::Four));
    assert_eq!(leak.iter().map(cells).collect::<Vec<_>>(), [vec![(6, 1), (6, 2)]]);
    assert!(detect(&grid, (1.5, 1.5), params(Reachability::WallsBlock, Neighbourhood::Four)).is_empty());
}

#[test]
fn small_frontiers_are_dropped() {
    let grid = OccupancyGrid::from_ascii("?....??\n#....##\n#....?#").unwrap();
    let all = params(Reachability::WallsBlock, Neighbourhood::Four);
    assert_eq!(detect(&grid, (2.5, 1.5), all).len(), 3);
    let large = DetectorParams { min_size_m: 2.0, ..params(Reachability::WallsBlock, Neighbourhood::Eight) };
    assert!(detect(&grid, (2.5, 1.5), large).iter().all(|f| f.cells.len() >= 2));
}

#[test]
fn greys_are_free_and_nothing_known_is_no_frontier() {
    let mut grid = OccupancyGrid::from_ascii("....?").unwrap();
    grid.data_mut()[..4].fill(47);
    assert_eq!(detect(&grid, (0.5, 0.5), DetectorParams::default()).len(), 1);
    let known = OccupancyGrid::from_ascii("...\n...").unwrap();
    assert!(detect(&known, (0.5, 0.5), DetectorParams::default()).is_empty());
}

/// The definition, restated: close the set of entered cells under the rule, take its
/// frontier cells, split them into connected components.
fn by_definition(grid: &OccupancyGrid, seed: Cell, params: &DetectorParams) -> BTreeSet<BTreeSet<Cell>> {
    let info = *grid.info();
    let all: Vec<Cell> = (0..info.len()).map(|i| info.cell(i)).collect();
    let state = |c: &Cell| grid.state(*c, &params.thresholds);
    let adjacent = |a: Cell, kind: Neighbourhood| info.neighbours(a, kind).collect::<Vec<_>>();
    let mut open: BTreeSet<Cell> = all.iter().copied().filter(|c| state(c) == CellState::Free).collect();
    if params.reachability == Reachability::WallsBlock {
        open = closure(BTreeSet::from([seed]), |c| {
            adjacent(c, Neighbourhood::Four).into_iter().filter(|n| open.contains(n)).collect()
        });
    }
    let near_open = |c: Cell| adjacent(c, params.neighbours).iter().any(|n| open.contains(n));
    let frontier: BTreeSet<Cell> =
        all.iter().copied().filter(|c| state(c) == CellState::Unknown && near_open(*c)).collect();
    let entered = match params.reachability {
        Reachability::WallsBlock => frontier.clone(),
        Reachability::Textbook => closure(BTreeSet::from([seed]), |c| {
            adjacent(c, params.neighbours).into_iter().filter(|&n| near_open(n)).collect()
        }),
    };
    let mut clusters = BTreeSet::new();
    for &cell in frontier.intersection(&entered) {
        clusters.insert(closure(BTreeSet::from([cell]), |c| {
            adjacent(c, params.neighbours).into_iter().filter(|n| frontier.contains(n)).collect()
        }));
    }
    clusters
}

fn closure(start: BTreeSet<Cell>, next: impl Fn(Cell) -> Vec<Cell>) -> BTreeSet<Cell> {
    let mut done = start.clone();
    let mut todo: Vec<Cell> = start.into_iter().collect();
    while let Some(cell) = todo.pop() {
        todo.extend(next(cell).into_iter().filter(|n| done.insert(*n)));
    }
    done
}

proptest! {
    #[test]
    fn equals_the_definition(
        (grid, seed) in noise(64, 64),
        textbook: bool,
        four: bool,
    ) {
        let params = params(
            if textbook { Reachability::Textbook } else { Reachability::WallsBlock },
            if four { Neighbourhood::Four } else { Neighbourhood::Eight },
        );
        let center = grid.info().center(seed);
        let found = detect(&grid, (center.x, center.y), params);
        let total: usize = found.iter().map(|f| f.cells.len()).sum();
        let as_sets: BTreeSet<BTreeSet<Cell>> = found.iter().map(|f| f.cells.iter().copied().collect()).collect();
        // Each cell in exactly one frontier: no cell is lost when lists become sets.
        prop_assert_eq!(total, as_sets.iter().map(BTreeSet::len).sum::<usize>());
        prop_assert_eq!(as_sets.len(), found.len());
        prop_assert_eq!(as_sets, by_definition(&grid, seed, &params));
    }
}
