//! A region drawn in RViz: corners come one by one as published points, and a click near
//! the first one closes the polygon.

use crate::geometry::{Point, Polygon};
use std::sync::{Mutex, PoisonError};

/// A click this near to the first corner closes the polygon, metres.
const CLOSE_M: f64 = 0.5;
/// Nobody draws more corners.
const MAX_CORNERS: usize = 200;

/// What a click did.
#[derive(Clone, Debug, PartialEq)]
pub enum Clicked {
    /// So many corners are there now.
    Corner(usize),
    /// The region is complete.
    Closed(Polygon),
    /// The corners make no region, with the reason; the drawing begins anew.
    Refused(String),
}

/// A drawing under way.
#[derive(Clone, Debug, Default)]
pub struct RegionDrawing {
    corners: Vec<Point>,
}

impl RegionDrawing {
    /// Takes a click at a point of the map frame.
    pub fn click(&mut self, at: Point) -> Clicked {
        if !(at.x.is_finite() && at.y.is_finite()) {
            return Clicked::Refused(format!("({}, {}): must be finite metres", at.x, at.y));
        }
        let closes = self.corners.len() >= 3
            && self.corners.first().is_some_and(|first| nalgebra::distance(first, &at) <= CLOSE_M);
        if !closes && self.corners.len() < MAX_CORNERS {
            self.corners.push(at);
            return Clicked::Corner(self.corners.len());
        }
        match Polygon::new(std::mem::take(&mut self.corners)) {
            Ok(region) => Clicked::Closed(region),
            Err(error) => Clicked::Refused(error.to_string()),
        }
    }
}

/// Whether a message is in the map's frame; an empty name is taken for it.
pub fn is_in_frame(map_frame: &Mutex<String>, frame: &str) -> bool {
    let map = map_frame.lock().unwrap_or_else(PoisonError::into_inner);
    let (map, frame) = (crate::tf::frame_name(&map), crate::tf::frame_name(frame));
    map.is_empty() || frame.is_empty() || map == frame
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_corners_and_a_click_on_the_first() {
        let mut drawing = RegionDrawing::default();
        for (i, (x, y)) in [(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0)].into_iter().enumerate() {
            assert_eq!(drawing.click(Point::new(x, y)), Clicked::Corner(i + 1));
        }
        let Clicked::Closed(region) = drawing.click(Point::new(0.3, 0.2)) else { panic!("not closed") };
        assert!(region.contains(Point::new(2.0, 1.0)) && !region.contains(Point::new(5.0, 1.0)));
        assert_eq!(drawing.click(Point::new(9.0, 9.0)), Clicked::Corner(1), "the next region begins");
    }

    #[test]
    fn near_corners_close_nothing_before_there_are_three() {
        let mut drawing = RegionDrawing::default();
        assert_eq!(drawing.click(Point::new(0.0, 0.0)), Clicked::Corner(1));
        assert_eq!(drawing.click(Point::new(0.1, 0.0)), Clicked::Corner(2));
        assert_eq!(drawing.click(Point::new(0.2, 0.0)), Clicked::Corner(3));
        assert!(matches!(drawing.click(Point::new(0.1, 0.0)), Clicked::Refused(_)), "a line is no region");
        assert!(matches!(drawing.click(Point::new(f64::NAN, 0.0)), Clicked::Refused(_)));
    }
}
