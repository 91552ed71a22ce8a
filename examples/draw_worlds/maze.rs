//! A maze of 11 m x 11 m: corridors 1 m wide between walls of 0.2 m, seven dead ends and
//! five loops.

use crate::canvas::Canvas;
use frontier_explorer::grid::{GridInfoError, OccupancyGrid};

/// Odd rows and columns are corridors, even ones the walls between them.
const PLAN: [&str; 19] = [
    "###################",
    "#.#.........#.....#",
    "#.###.#####.#.#####",
    "#.#...#.....#.....#",
    "#.#.###.#####.###.#",
    "#.#...#...........#",
    "#.###.#.#########.#",
    "#...............#.#",
    "#######.#######.#.#",
    "#.....#...#...#.#.#",
    "#.#.###.#.#.#.###.#",
    "#.#...#.#...#...#.#",
    "#.###.#.#######.#.#",
    "#.#.....#.....#...#",
    "#.#.###.#.###.#####",
    "#.......#.#.#.....#",
    "#######.#.#.#####.#",
    "#.........#.......#",
    "###################",
];

/// Thickness of a wall in metres.
const WALL_M: f64 = 0.2;
/// From one corridor to the next in metres.
const PITCH_M: f64 = 1.2;
/// Unknown ground around the maze in metres.
const MARGIN_M: f64 = 0.5;

/// Draws the maze.
pub fn draw() -> Result<OccupancyGrid, GridInfoError> {
    let mut c = Canvas::new(12.0, 12.0, WALL_M)?;
    for (row, line) in PLAN.iter().rev().enumerate() {
        let (bottom, top) = (edge(row), edge(row + 1));
        for (column, symbol) in line.chars().enumerate() {
            let (left, right) = (edge(column), edge(column + 1));
            if symbol == '#' {
                c.block(left, bottom, right - left, top - bottom);
            } else {
                c.floor([left, bottom, right, top]);
            }
        }
    }
    Ok(c.finish())
}

/// Where a row or column of the plan begins, in metres.
fn edge(index: usize) -> f64 {
    MARGIN_M + PITCH_M * (index / 2) as f64 + WALL_M * (index % 2) as f64
}
