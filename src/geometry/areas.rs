//! Where a robot may be: the region that it keeps to, and the areas that it keeps out of.

use super::{Point, Polygon};
use serde::{Deserialize, Serialize};

/// A region to explore and areas that are not to be entered, in metres of the map frame.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Areas {
    /// The region that the robot keeps to; everywhere when absent.
    pub region: Option<Polygon>,
    /// The areas that it keeps out of.
    pub no_go: Vec<Polygon>,
}

impl Areas {
    /// Whether they forbid nothing.
    #[must_use]
    pub const fn are_everywhere(&self) -> bool {
        self.region.is_none() && self.no_go.is_empty()
    }

    /// Whether the robot's centre may be at a point of the map frame.
    #[must_use]
    pub fn contain(&self, point: Point) -> bool {
        self.is_in_region(point) && !self.is_in_no_go(point)
    }

    /// Whether a point lies in the region, if there is one.
    #[must_use]
    pub fn is_in_region(&self, point: Point) -> bool {
        self.region.as_ref().is_none_or(|region| region.contains(point))
    }

    /// Whether a point lies in an area that is not to be entered.
    #[must_use]
    pub fn is_in_no_go(&self, point: Point) -> bool {
        self.no_go.iter().any(|area| area.contains(point))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_no_go_area_is_cut_out_of_the_region() {
        let square = |x: f64, size: f64| {
            Polygon::try_from(vec![[x, 0.0], [x + size, 0.0], [x + size, size], [x, size]]).unwrap()
        };
        let areas = Areas { region: Some(square(0.0, 4.0)), no_go: vec![square(1.0, 1.0)] };
        assert!(areas.contain(Point::new(0.5, 0.5)) && areas.contain(Point::new(3.0, 3.0)));
        assert!(!areas.contain(Point::new(1.5, 0.5)) && !areas.contain(Point::new(5.0, 0.5)));
        assert!(Areas::default().contain(Point::new(99.0, 0.0)) && Areas::default().are_everywhere());
    }
}
