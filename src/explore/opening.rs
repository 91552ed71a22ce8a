//! Whether a robot's body gets into what a frontier opens: the crack between two dots of a wall,
//! the gap between two legs and the slit beside a cupboard are no way in.

use crate::frontier::Frontier;
use crate::grid::{Cell, Costmap, GridInfo, INSCRIBED_COST, LETHAL_COST, NEIGHBOURS_8};
use std::collections::HashSet;

/// So far around a frontier a place is looked for from which it is entered, metres.
const AROUND_M: f64 = 1.0;

/// Whether nowhere around a frontier the robot's centre may be in a known cell from which it gets to
/// a cell of the frontier, as far as is known: what is unknown may all be free.
///
/// O(cells around the frontier); where it is entered from beside it, which is nearly everywhere, a look
/// at its first cells.
pub fn is_too_narrow(frontier: &Frontier, info: &GridInfo, costmap: &Costmap) -> bool {
    let is_open = |cell: Cell| !matches!(costmap.cost(cell), INSCRIBED_COST | LETHAL_COST);
    let beside = |cell: Cell| NEIGHBOURS_8.iter().map(move |&by| cell.offset(by));
    let is_same_grid = costmap.info() == info;
    let to_costmap = |&cell: &Cell| if is_same_grid { cell } else { costmap.info().cell_at(info.center(cell)) };
    let open = || frontier.cells.iter().map(to_costmap).filter(|&cell| is_open(cell));
    if open().any(|cell| costmap.is_passable(cell) || beside(cell).any(|cell| costmap.is_passable(cell))) {
        return false;
    }
    let mut waiting: Vec<Cell> = open().collect();
    let around = costmap.info().cells(AROUND_M).ceil() as i32;
    let Some(bounds) = Bounds::of(&waiting, around) else { return true };
    let mut seen: HashSet<Cell> = waiting.iter().copied().collect();
    while let Some(cell) = waiting.pop() {
        if costmap.is_passable(cell) {
            return false;
        }
        for next in beside(cell) {
            if bounds.hold(next) && is_open(next) && seen.insert(next) {
                waiting.push(next);
            }
        }
    }
    true
}

/// The corners of a rectangle of cells, some of which may lie outside of the grid: there all is unknown.
struct Bounds {
    low: Cell,
    high: Cell,
}

impl Bounds {
    /// Around some cells, and so many more on every side.
    fn of(cells: &[Cell], more: i32) -> Option<Self> {
        let (first, others) = cells.split_first()?;
        let (low, high) = others.iter().fold((*first, *first), |(low, high), cell| {
            (Cell::new(low.x.min(cell.x), low.y.min(cell.y)), Cell::new(high.x.max(cell.x), high.y.max(cell.y)))
        });
        Some(Self { low: low.offset((-more, -more)), high: high.offset((more, more)) })
    }

    fn hold(&self, cell: Cell) -> bool {
        (self.low.x..=self.high.x).contains(&cell.x) && (self.low.y..=self.high.y).contains(&cell.y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frontier::{Bitplane, DetectionInput, DetectorParams, FrontierDetector as _};
    use crate::geometry::Pose;
    use crate::grid::{Inflation, OccupancyGrid, Thresholds};

    /// Of each frontier of a drawing with cells of 0.1 m, whether a robot of 0.18 m does not get into it.
    fn too_narrow(drawing: &str) -> Vec<bool> {
        let drawn = OccupancyGrid::from_ascii(drawing).unwrap();
        let (width, height) = (drawn.info().width() as u32, drawn.info().height() as u32);
        let info = GridInfo::new(width, height, 0.1, Pose::default()).unwrap();
        let grid = OccupancyGrid::new(info, drawn.data().to_vec()).unwrap();
        let inflation = Inflation {
            inscribed_radius_m: 0.18,
            clear_radius_m: 0.0,
            inflation_radius_m: 0.3,
            cost_scaling_factor: 5.0,
        };
        let costmap = Costmap::inflate(&grid, &Thresholds::default(), &inflation);
        let input = DetectionInput::new(&grid, Pose::new(0.5, 0.2, 0.0));
        let frontiers = Bitplane::new(DetectorParams::default()).detect(&input).unwrap();
        frontiers.iter().map(|frontier| is_too_narrow(frontier, &info, &costmap)).collect()
    }

    #[test]
    fn a_slit_beside_a_cupboard_is_no_way_in_and_a_door_is_one() {
        // The inside of the cupboard is unknown and wider than the robot; a slit leads along it.
        let cupboard = "\
####################
#??????????#########
#??????????.########
#??????????.########
#??????????.########
#??????????.########
#??????????.########
###########.########
#..................#
#..................#
#..................#
####################";
        assert_eq!(too_narrow(cupboard), [true]);
        let door = cupboard.replace("###########.########", "####.....##.########");
        assert!(!too_narrow(&door).contains(&true));
    }

    #[test]
    fn the_far_side_of_a_gap_is_entered_from_there() {
        // A known place beyond a gap that is too tight: another way may lead there.
        let beyond = "\
####################
#........???????????
#........???????????
#........???????????
#........???????????
####.###############
#........#
#........#
#........#
##########";
        let beyond: Vec<String> = beyond.lines().map(|line| format!("{line:?<20}")).collect();
        let found = too_narrow(&beyond.join("\n"));
        assert!(!found.is_empty() && !found.contains(&true), "{found:?}");
    }
}
