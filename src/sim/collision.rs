//! Whether a footprint fits into the world at a pose.
//!
//! costmap_2d's rules on the ground truth: a disc by the clearance of its centre's
//! cell, a polygon by its inscribed disc and by the cells under its outline. A path
//! over the costmap of a true map so never leads into a collision.

use super::{World, WorldError};
use crate::geometry::{Footprint, Point, Pose};

/// A footprint prepared for many checks.
#[derive(Clone, Debug)]
pub struct CollisionShape {
    inscribed_m: f64,
    circumscribed_m: f64,
    /// Points on the outline in the base frame; none for a disc.
    outline_in_base: Vec<Point>,
}

impl CollisionShape {
    /// Prepares a footprint for worlds with cells of `resolution_m`.
    #[must_use]
    pub fn new(footprint: &Footprint, resolution_m: f64) -> Self {
        let outline_in_base = match footprint {
            Footprint::RadiusM(_) => Vec::new(),
            Footprint::PolygonM(_) => footprint.outline(&Pose::default(), 0.5 * resolution_m),
        };
        Self {
            inscribed_m: footprint.inscribed_radius_m(),
            circumscribed_m: footprint.circumscribed_radius_m(),
            outline_in_base,
        }
    }

    /// Radius in metres of the smallest disc around the base that holds the body.
    #[must_use]
    pub const fn circumscribed_radius_m(&self) -> f64 {
        self.circumscribed_m
    }

    /// Checks that a robot can start at a pose.
    ///
    /// # Errors
    /// [`WorldError`] that says how much room there is and how much is needed.
    pub fn check_start(&self, world: &World, start: &Pose) -> Result<(), WorldError> {
        let Pose { x, y, yaw } = *start;
        if !start.is_finite() {
            return Err(WorldError::StartNotFinite { x, y, yaw });
        }
        if !world.info().contains(world.info().cell_at(start.position())) {
            return Err(WorldError::StartOutside { x, y });
        }
        let clearance_m = world.clearance_m(start.position());
        if clearance_m <= self.inscribed_m {
            return Err(WorldError::StartBlocked { x, y, clearance_m, needed_m: self.inscribed_m });
        }
        if !self.fits(world, start) {
            return Err(WorldError::StartBlocked { x, y, clearance_m, needed_m: self.circumscribed_m });
        }
        Ok(())
    }

    /// Whether the body touches nothing solid at a pose.
    #[must_use]
    pub fn fits(&self, world: &World, pose: &Pose) -> bool {
        let clearance_m = world.clearance_m(pose.position());
        // The base is within half a diagonal of its cell's centre, and so is the
        // nearest solid point of that cell's.
        let surely_m = self.circumscribed_m + std::f64::consts::SQRT_2 * world.info().resolution_m();
        if clearance_m <= self.inscribed_m {
            return false;
        }
        if clearance_m > surely_m {
            return true;
        }
        let base = pose.isometry();
        !self.outline_in_base.iter().any(|point| world.is_solid(world.info().cell_at(base * point)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::{OccupancyGrid, Thresholds};

    fn world(drawing: &str) -> World {
        World::new(&OccupancyGrid::from_ascii(drawing).unwrap(), &Thresholds::default()).unwrap()
    }

    #[test]
    fn a_disc_fits_where_the_costmap_says_so() {
        let w = world("#......");
        let body = CollisionShape::new(&Footprint::RadiusM(0.9), 1.0);
        let fits: Vec<bool> = (0..7).map(|x| body.fits(&w, &Pose::new(f64::from(x) + 0.5, 0.5, 0.0))).collect();
        // One row: the rim is one cell away everywhere.
        assert_eq!(fits, [false, true, true, true, true, true, true]);
    }

    #[test]
    fn a_rectangle_fits_lengthwise_only() {
        let w = world(".......\n.......\n.......");
        let long = Footprint::PolygonM(vec![[-2.5, -0.4], [2.5, -0.4], [2.5, 0.4], [-2.5, 0.4]]);
        let body = CollisionShape::new(&long, 1.0);
        assert!(body.fits(&w, &Pose::new(3.5, 1.5, 0.0)));
        assert!(!body.fits(&w, &Pose::new(3.5, 1.5, 1.2)));
        assert!(!body.fits(&w, &Pose::new(5.5, 1.5, 0.0)));
    }

    #[test]
    fn a_bad_start_says_what_it_has_and_needs() {
        let w = world(".....\n.....\n.....\n.....\n.....");
        let disc = CollisionShape::new(&Footprint::RadiusM(1.5), 1.0);
        assert_eq!(disc.check_start(&w, &Pose::new(2.5, 2.5, 0.0)), Ok(()));
        let error = disc.check_start(&w, &Pose::new(0.5, 2.5, 0.0)).unwrap_err();
        assert_eq!(
            error.to_string(),
            "the start (0.50, 2.50) m has 1.000 m to the nearest solid cell: the robot needs more than 1.500 m"
        );
        let outside = disc.check_start(&w, &Pose::new(-0.5, 2.5, 0.0));
        assert_eq!(outside, Err(WorldError::StartOutside { x: -0.5, y: 2.5 }));
        assert!(disc.check_start(&w, &Pose::new(f64::NAN, 2.5, 0.0)).is_err());
    }

    #[test]
    fn a_long_robot_must_fit_with_its_heading() {
        let w = world(".......\n.......\n.......");
        let long =
            CollisionShape::new(&Footprint::PolygonM(vec![[-2.5, -0.5], [2.5, -0.5], [2.5, 0.5], [-2.5, 0.5]]), 1.0);
        assert_eq!(long.check_start(&w, &Pose::new(3.5, 1.5, 0.0)), Ok(()));
        let across = long.check_start(&w, &Pose::new(3.5, 1.5, 1.5));
        assert!(matches!(across, Err(WorldError::StartBlocked { needed_m, .. }) if needed_m > 2.5));
    }
}
