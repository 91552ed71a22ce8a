//! A message with corners or a click, and its points in the map's frame.

use crate::geometry::Point;
use crate::ros::transforms::Transforms;
use crate::tf::frame_name;
use nalgebra::Point3;
use std::time::Instant;

/// So many messages wait for a map or a frame: of more, the oldest are forgotten.
const MOST_WAITING: usize = 50;

/// What a message asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wish {
    /// Explore a region, or everything.
    SetRegion,
    /// Keep out of one more area, or of none.
    AddNoGo,
    /// A corner of a region.
    RegionClick,
    /// A corner of a no-go area.
    NoGoClick,
    /// Explore a region, as a goal of the action orders it.
    Order,
}

impl Wish {
    /// What its points are, for sentences.
    pub const fn name(self) -> &'static str {
        match self {
            Self::SetRegion => "the corners on ~set_region",
            Self::AddNoGo => "the corners on ~add_no_go",
            Self::RegionClick => "the point on clicked_point",
            Self::NoGoClick => "the point on ~no_go_point",
            Self::Order => "the corners of the region",
        }
    }
}

/// A message with its points, in its own frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Asked {
    /// What it asks for.
    pub wish: Wish,
    /// The frame of its points.
    pub frame: String,
    /// When that was, seconds of ROS time.
    pub stamp_s: f64,
    /// The points, metres.
    pub points: Vec<Point3<f64>>,
}

impl Asked {
    /// Whether it says in which frame its points are; an empty name is taken for the map's.
    pub fn names_a_frame(&self) -> bool {
        !frame_name(&self.frame).is_empty()
    }

    /// The points in the map's frame.
    ///
    /// # Errors
    /// A sentence with both frames where tf does not bring one to the other.
    pub fn to_map(&self, transforms: &Transforms, map: &str) -> Result<Vec<Point>, String> {
        let frame = frame_name(&self.frame);
        let flat = |point: Point3<f64>| Point::new(point.x, point.y);
        if frame.is_empty() || frame == frame_name(map) {
            return Ok(self.points.iter().copied().map(flat).collect());
        }
        let placed = transforms.place(map, frame, self.stamp_s).map_err(|error| {
            let name = self.wish.name();
            format!("{name} cannot be brought from the frame {frame} to the map's frame {map}: {error}")
        })?;
        Ok(self.points.iter().map(|point| flat(placed * point)).collect())
    }
}

/// Has one more wait, and no more than [`MOST_WAITING`] in all.
pub fn wait_with(waiting: &mut Vec<(Asked, Option<Instant>)>, asked: Asked) {
    if waiting.len() >= MOST_WAITING {
        waiting.remove(0);
    }
    waiting.push((asked, None));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_too_many_that_wait_the_oldest_are_forgotten() {
        let mut waiting = Vec::new();
        for stamp_s in 0..200 {
            let (wish, frame) = (Wish::SetRegion, "nowhere".to_owned());
            wait_with(&mut waiting, Asked { wish, frame, stamp_s: f64::from(stamp_s), points: Vec::new() });
        }
        let kept = waiting.iter().map(|(asked, _)| asked.stamp_s);
        assert!(kept.eq((150..200).map(f64::from)), "{}", waiting.len());
    }
}
