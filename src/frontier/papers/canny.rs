//! Frontiers as Canny edges of the map under the costmap.
//!
//! The winter project of Northwestern University: the map is overlaid with the costmap,
//! so that its static and inflation layers count as blocked, and drawn with free cells
//! white, unknown ones grey and blocked ones black; of the Canny edges (Canny 1986, with
//! a Gaussian of 1.4 cells) those are kept that lie between the
//! free and the unknown; adjacent ones form a frontier, whose centroid is the goal.
//! O(cells of the grid); without a costmap the map alone is drawn.
//!
//! | parameter | unit | project |
//! |---|---|---|
//! | `low_threshold`, `high_threshold` | gradient of the picture | not said |
//! | `blocked_cost_min` | cost, 1..=254 | not said |
//! | `neighbours` | which cells are "beside" and "adjacent" | not said |
//!
//! An edge goes on along these alone, not by way of a wall. A straight border between
//! free and unknown has a gradient of about 265, so the
//! defaults find it and leave out single grey cells. The cells of a frontier lie on
//! either side of the boundary. Cells on the rim of the grid have no edge: a map that is
//! known up to its rim has no frontier there. Frontiers of a cell or two vanish in the
//! blur. Where white, grey and black meet, Canny leaves gaps, and bits of two or three
//! cells beside a wall are frontiers of their own: `min_size_m` drops them.

mod edges;
mod params;

pub use params::CannyParams;

use crate::bits::BitPlane;
use crate::frontier::papers::groups::group;
use crate::frontier::papers::territory::{Territory, cells, with_neighbours};
use crate::frontier::{CellSide, DetectError, DetectionInput, DetectorParams, Frontier, FrontierDetector, number};
use crate::grid::{Cell, Neighbourhood, Thresholds, UNKNOWN_COST};
use edges::Blurred;
use std::borrow::Cow;

/// Grey values of the picture.
const WHITE: u8 = 255;
const GREY: u8 = 127;
const BLACK: u8 = 0;

/// The detector.
///
/// What the costmap blocks is black in the picture, and its edge is none of the unknown's:
///
/// ```
/// use frontier_explorer::frontier::{Canny, DetectionInput, DetectorParams, FrontierDetector};
/// use frontier_explorer::geometry::Pose;
/// use frontier_explorer::grid::{Costmap, INSCRIBED_COST, OccupancyGrid};
///
/// let grid = OccupancyGrid::from_ascii(&[".......???????"; 12].join("\n")).unwrap();
/// let (info, mut detector) = (*grid.info(), Canny::new(DetectorParams::default()));
/// let map_alone = DetectionInput::new(&grid, Pose::new(1.5, 6.5, 0.0));
/// assert_eq!(detector.detect(&map_alone)?.len(), 1);
/// // The robot's centre cannot be within two cells of the boundary.
/// let costs = (0..info.len()).map(|index| if info.cell(index).x < 5 { 0 } else { INSCRIBED_COST }).collect();
/// let costmap = Costmap::from_costs(info, costs).unwrap();
/// assert_eq!(detector.detect(&DetectionInput { costmap: Some(&costmap), ..map_alone })?.len(), 0);
/// # Ok::<(), frontier_explorer::frontier::DetectError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Canny {
    params: DetectorParams,
}

impl Canny {
    /// A detector with these parameters.
    #[must_use]
    pub const fn new(params: DetectorParams) -> Self {
        Self { params }
    }
}

impl FrontierDetector for Canny {
    fn name(&self) -> &'static str {
        "canny"
    }

    fn detect(&mut self, input: &DetectionInput<'_>) -> Result<Vec<Frontier>, DetectError> {
        let info = input.grid.info();
        let params = &self.params.canny;
        let territory = Territory::of(input, &self.params)?;
        let picture = draw(input, &self.params.thresholds, params.blocked_cost_min);
        let cells = between(&territory, &picture, self.params.neighbours);
        let (low, high) = (f64::from(params.low_threshold), f64::from(params.high_threshold));
        let cells = Blurred::new(info, &picture, &cells).edges(&cells, low, high);
        let mut frontiers = group(info, &cells, self.params.neighbours);
        let min_cells = self.params.min_cells(info);
        frontiers.retain(|cells| cells.len() >= min_cells);
        Ok(number(frontiers, CellSide::Either))
    }
}

/// The picture, row 0 of the grid first: edges do not mind. What the costmap does not
/// know blocks nothing, and neither does what lies outside it.
fn draw(input: &DetectionInput<'_>, thresholds: &Thresholds, blocked_cost_min: u8) -> Vec<u8> {
    let info = input.grid.info();
    let free_max = thresholds.free_max;
    let is_blocked = |cost: u8| (cost >= blocked_cost_min) & (cost != UNKNOWN_COST);
    let grey = |(&value, &cost): (&i8, &u8)| {
        let shade = if value >= 0 { WHITE } else { GREY };
        if (value > free_max) | is_blocked(cost) { BLACK } else { shade }
    };
    let costs: Cow<'_, [u8]> = match input.costmap {
        Some(costmap) if costmap.info() == info => costmap.costs().into(),
        Some(costmap) => (0..info.len()).map(|index| costmap.cost_at(info.center(info.cell(index)))).collect(),
        None => vec![UNKNOWN_COST; info.len()].into(),
    };
    input.grid.data().iter().zip(&*costs).map(grey).collect()
}

/// The cells that have both an open and an unknown cell among them and their
/// neighbours, row-major.
fn between(territory: &Territory, picture: &[u8], neighbours: Neighbourhood) -> Vec<Cell> {
    let width = territory.open.width();
    // White is drawn also where the robot cannot get to.
    let mut open = BitPlane::of_values(width, picture, |grey| grey == WHITE);
    open.intersect(&territory.open);
    let unknown = BitPlane::of_values(width, picture, |grey| grey == GREY);
    let mut between = with_neighbours(&open, neighbours);
    between.intersect(&with_neighbours(&unknown, neighbours));
    cells(&between)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Pose;
    use crate::grid::{Costmap, GridInfo, Inflation, LETHAL_COST, OccupancyGrid};

    /// A room of 20 x 20 cells of 0.1 m with an open right side, in the unknown.
    fn room() -> OccupancyGrid {
        let info = GridInfo::new(40, 30, 0.1, Pose::default()).unwrap();
        let mut grid = OccupancyGrid::filled(info, OccupancyGrid::UNKNOWN);
        for y in 5..25 {
            for x in 5..25 {
                let wall = y == 5 || y == 24 || x == 5;
                grid.set(Cell::new(x, y), if wall { OccupancyGrid::OCCUPIED } else { OccupancyGrid::FREE });
            }
        }
        grid
    }

    fn detect(grid: &OccupancyGrid, costmap: Option<&Costmap>) -> Vec<Frontier> {
        let input = DetectionInput { costmap, ..DetectionInput::new(grid, Pose::new(1.5, 1.5, 0.0)) };
        Canny::new(DetectorParams { min_size_m: 0.3, ..DetectorParams::default() }).detect(&input).unwrap()
    }

    #[test]
    fn only_the_edge_towards_the_unknown_is_kept() {
        let found = detect(&room(), None);
        assert_eq!(found.len(), 1);
        let cells = &found[0].cells;
        assert!(cells.iter().all(|c| (23..=26).contains(&c.x) && (5..=24).contains(&c.y)), "{cells:?}");
        assert!(cells.iter().any(|c| c.y == 15));
        let centroid = found[0].centroid(room().info());
        assert!((centroid - crate::geometry::Point::new(2.5, 1.5)).norm() < 0.1, "{centroid}");
    }

    #[test]
    fn what_the_costmap_blocks_is_no_frontier() {
        let grid = room();
        let inflation = Inflation {
            inscribed_radius_m: 0.4,
            clear_radius_m: 0.0,
            inflation_radius_m: 0.5,
            cost_scaling_factor: 1.0,
        };
        let costmap = Costmap::inflate(&grid, &Thresholds::default(), &inflation);
        let found = detect(&grid, Some(&costmap));
        assert_eq!(found.len(), 1, "{found:?}");
        // The outermost edge cells are beside open space, not in it.
        assert!(found[0].cells.iter().all(|c| (9..=20).contains(&c.y)), "{:?}", found[0].cells);
        assert!(found[0].cells.len() < detect(&grid, None)[0].cells.len());
    }

    #[test]
    fn a_costmap_of_another_place_blocks_nothing_outside_itself() {
        let grid = room();
        let elsewhere = GridInfo::new(4, 4, 0.05, Pose::new(50.0, 50.0, 0.3)).unwrap();
        let costmap = Costmap::from_costs(elsewhere, vec![LETHAL_COST; 16]).unwrap();
        assert_eq!(detect(&grid, Some(&costmap)), detect(&grid, None));
    }

    #[test]
    fn thresholds_out_of_order_are_refused() {
        let error = |canny| DetectorParams { canny, ..DetectorParams::default() }.validate().unwrap_err().to_string();
        let swapped = CannyParams { low_threshold: 200.0, ..CannyParams::default() };
        assert_eq!(error(swapped), "detector.canny.high_threshold is 120: must be finite and >= low_threshold");
        let zero = CannyParams { low_threshold: 0.0, ..CannyParams::default() };
        assert_eq!(error(zero), "detector.canny.low_threshold is 0: must be finite and > 0");
    }
}
