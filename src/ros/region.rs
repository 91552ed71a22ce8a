//! Areas drawn in RViz: corners come one by one as published points; a click near the first one
//! closes the polygon, and one near the last takes that back.

use crate::geometry::{Point, Polygon};

/// A click this near to a corner means that corner, metres.
const NEAR_M: f64 = 0.5;
/// Nobody draws more corners.
const MAX_CORNERS: usize = 200;

/// What a click did.
#[derive(Clone, Debug, PartialEq)]
pub enum Clicked {
    /// One more corner: so many are there now.
    Corner(usize),
    /// The last corner was taken back: so many are left.
    TakenBack(usize),
    /// The area is complete.
    Closed(Polygon),
    /// A corner of the complete area with this number was meant: it shall be cleared.
    Clear(usize),
    /// The corners make no area, with the reason; the drawing begins anew.
    Refused(String),
}

/// A drawing under way.
#[derive(Clone, Debug, Default)]
pub struct AreaDrawing {
    corners: Vec<Point>,
}

impl AreaDrawing {
    /// The corners so far.
    #[must_use]
    pub fn corners(&self) -> &[Point] {
        &self.corners
    }

    /// Takes a click at a point of the map frame; `closed` are the areas that are complete.
    pub fn click(&mut self, at: Point, closed: &[&Polygon]) -> Clicked {
        if !(at.x.is_finite() && at.y.is_finite()) {
            return Clicked::Refused(format!("({}, {}): must be finite metres", at.x, at.y));
        }
        let away_m = |corner: &Point| nalgebra::distance(corner, &at);
        let is_near = |corner: &Point| away_m(corner) <= NEAR_M;
        if self.corners.is_empty()
            && let Some(number) = closed.iter().position(|area| area.corners().iter().any(is_near))
        {
            return Clicked::Clear(number);
        }
        let last_m = self.corners.last().map_or(f64::INFINITY, away_m);
        let means_first = |first: &Point| is_near(first) && away_m(first) <= last_m;
        let closes = self.corners.len() >= 3 && self.corners.first().is_some_and(means_first);
        if !closes && last_m <= NEAR_M {
            self.corners.pop();
            return Clicked::TakenBack(self.corners.len());
        }
        if !closes && self.corners.len() < MAX_CORNERS {
            self.corners.push(at);
            return Clicked::Corner(self.corners.len());
        }
        match Polygon::new(std::mem::take(&mut self.corners)) {
            Ok(area) => Clicked::Closed(area),
            Err(error) => Clicked::Refused(error.to_string()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_corners_and_a_click_on_the_first() {
        let mut drawing = AreaDrawing::default();
        for (i, (x, y)) in [(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0)].into_iter().enumerate() {
            assert_eq!(drawing.click(Point::new(x, y), &[]), Clicked::Corner(i + 1));
        }
        let Clicked::Closed(region) = drawing.click(Point::new(0.3, 0.2), &[]) else { panic!("not closed") };
        assert!(region.contains(Point::new(2.0, 1.0)) && !region.contains(Point::new(5.0, 1.0)));
        assert!(drawing.corners().is_empty());
        assert_eq!(drawing.click(Point::new(9.0, 9.0), &[&region]), Clicked::Corner(1), "the next region begins");
        assert_eq!(drawing.click(Point::new(4.0, 0.2), &[&region]), Clicked::Corner(2), "while one is drawn");
        drawing = AreaDrawing::default();
        assert_eq!(drawing.click(Point::new(4.0, 0.2), &[&region]), Clicked::Clear(0));
    }

    #[test]
    fn a_click_near_the_last_corner_takes_it_back() {
        let mut drawing = AreaDrawing::default();
        let mut click = |x: f64, y: f64| drawing.click(Point::new(x, y), &[]);
        assert_eq!((click(0.0, 0.0), click(0.1, 0.0)), (Clicked::Corner(1), Clicked::TakenBack(0)));
        assert_eq!((click(0.0, 0.0), click(2.0, 0.0)), (Clicked::Corner(1), Clicked::Corner(2)));
        assert_eq!((click(2.1, 0.2), click(4.0, 0.0)), (Clicked::TakenBack(1), Clicked::Corner(2)));
        assert_eq!(
            (click(0.0, 0.1), click(0.0, 0.2)),
            (Clicked::Corner(3), Clicked::TakenBack(2)),
            "two close nothing"
        );
        assert_eq!(click(8.0, 0.0), Clicked::Corner(3));
        assert!(matches!(click(0.1, 0.0), Clicked::Refused(_)), "a line is no area");
        assert!(matches!(click(f64::NAN, 0.0), Clicked::Refused(_)));
    }
}
