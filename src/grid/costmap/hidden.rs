//! Whether a published costmap tells the unknown apart from the free. costmap_2d does so only
//! with `track_unknown_space`: without, what nobody has seen costs nothing.

use crate::grid::OccupancyGrid;

/// A smaller share of unknown cells may rightly vanish in a costmap: specks below inflated
/// obstacles.
const MIN_SHARE: f64 = 0.01;
/// About so many cells of the map are looked at.
const SAMPLES: usize = 20_000;

/// Of the map's cells that a published costmap of the same frame covers, the share that is
/// unknown, 0 to 1, where the costmap has no unknown cell at all. `None` where it has one, or
/// where next to nothing below it is unknown.
#[must_use]
pub fn unknown_share_hidden_by(costmap: &OccupancyGrid, map: &OccupancyGrid) -> Option<f64> {
    if costmap.data().iter().any(|&value| value < 0) {
        return None;
    }
    // An odd step meets all columns.
    let step = (map.info().len() / SAMPLES) | 1;
    let (mut covered, mut unknown) = (0_usize, 0_usize);
    for (index, &value) in map.data().iter().enumerate().step_by(step) {
        let point = map.info().center(map.info().cell(index));
        if costmap.info().contains(costmap.info().cell_at(point)) {
            covered += 1;
            unknown += usize::from(value < 0);
        }
    }
    let share = unknown as f64 / covered.max(1) as f64;
    (share >= MIN_SHARE).then_some(share)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(costmap: &str, map: &str, expected: Option<f64>) {
        let grid = |drawing| OccupancyGrid::from_ascii(drawing).unwrap();
        assert_eq!(unknown_share_hidden_by(&grid(costmap), &grid(map)), expected, "{costmap} over {map}");
    }

    #[test]
    fn a_costmap_that_shows_nothing_as_unknown_hides_what_is() {
        check("....\n....", "..??\n.???", Some(0.625));
        check("...?\n....", "..??\n.???", None);
        check("....\n....", "....\n#...", None);
    }

    #[test]
    fn only_what_the_costmap_covers_counts() {
        check("..", "..??", None);
        check("...", "..??", Some(1.0 / 3.0));
    }
}
