//! Which map is believed, and whether it shows what the robot has seen.
//!
//! Maps are compared by their versions, not by their stamps: gmapping stamps a map when it
//! is sent, sends none while the robot stands, and in an f64 of seconds since 1970 a
//! nanosecond vanishes.

use crate::geometry::{Pose, shortest_angle};
use crate::grid::{LiveCensus, Thresholds};
use crate::robot::MapSnapshot;
use crate::scan::Sight;

/// Motion below this is trembling of the pose, metres and radians.
const STILL_M: f64 = 0.05;
const STILL_RAD: f64 = 0.1;
/// After so much motion a mapper owes a map (gmapping's defaults are 1 m and 0.5 rad).
const DUE_M: f64 = 1.0;
const DUE_RAD: f64 = 0.6;
/// A map that knows less than this share of the last one needs a second that agrees.
const LEAST_SHARE: f64 = 0.5;
/// So may the resolution differ, as a share.
const SAME_RESOLUTION: f64 = 0.01;

/// The map that is believed, and the robot's motion since it came.
#[derive(Clone, Debug)]
pub struct MapWatch {
    /// Turning by less than this shows the lidar nothing new, radians.
    new_view_rad: f64,
    believed: Option<Believed>,
    /// Counts what maps know, also those that are doubted.
    census: LiveCensus,
    /// A map that is too different to be believed at once, with what it knows.
    doubted: Option<(u64, usize, f64)>,
    anchor: Option<Pose>,
    /// Where the robot was when it last came to see something new.
    view: Option<Pose>,
    /// The version of the map that was there then.
    moved_at_version: u64,
    moved_m: f64,
    turned_rad: f64,
    /// Since when a newer map is due, seconds.
    due_since_s: Option<f64>,
}

#[derive(Clone, Debug)]
struct Believed {
    map: MapSnapshot,
    known_cells: usize,
}

impl MapWatch {
    /// No map yet, for a lidar. One that sees all round sees the same from one place however
    /// it is turned, and gmapping sends its map in the middle of a turn.
    #[must_use]
    pub fn new(sight: &Sight) -> Self {
        let new_view_rad = if sight.is_all_round() { f64::INFINITY } else { 0.5 * sight.field_of_view_rad };
        Self {
            new_view_rad: new_view_rad.max(STILL_RAD),
            believed: None,
            // What is known does not depend on the thresholds.
            census: LiveCensus::new(Thresholds::default()),
            doubted: None,
            anchor: None,
            view: None,
            moved_at_version: 0,
            moved_m: 0.0,
            turned_rad: 0.0,
            due_since_s: None,
        }
    }

    /// Takes in the newest map and the robot's pose; what to say where a map is held back.
    pub fn update(&mut self, newest: Option<&MapSnapshot>, pose: Option<&Pose>, now_s: f64) -> Option<String> {
        let notice = newest.and_then(|map| self.take(map));
        if let Some(pose) = pose {
            self.follow(pose, now_s);
        }
        notice
    }

    /// The map that is believed.
    #[must_use]
    pub fn map(&self) -> Option<&MapSnapshot> {
        self.believed.as_ref().map(|believed| &believed.map)
    }

    /// Its version; 0 before the first.
    #[must_use]
    pub fn version(&self) -> u64 {
        self.map().map_or(0, MapSnapshot::version)
    }

    /// The known area of the map that is believed, square metres.
    #[must_use]
    pub fn known_m2(&self) -> f64 {
        self.believed.as_ref().map_or(0.0, |b| b.known_cells as f64 * b.map.grid.info().cell_area_m2())
    }

    /// Whether the map came after the robot last moved so that it sees something new.
    #[must_use]
    pub fn is_fresh(&self) -> bool {
        self.map().is_some_and(|map| map.version() > self.moved_at_version)
    }

    /// How long a map has been due, seconds: the robot moved enough for one, and none came.
    #[must_use]
    pub fn overdue_s(&self, now_s: f64) -> f64 {
        self.due_since_s.map_or(0.0, |since_s| now_s - since_s)
    }

    /// The time stood still, as in a pause.
    pub fn pause(&mut self, now_s: f64) {
        if let Some(since_s) = &mut self.due_since_s {
            *since_s = now_s;
        }
    }

    fn take(&mut self, map: &MapSnapshot) -> Option<String> {
        if self.map().is_some_and(|believed| believed.version() == map.version()) {
            // Its costmap may be a newer one.
            if let Some(believed) = &mut self.believed {
                believed.map = map.clone();
            }
            return None;
        }
        // One that is doubted is counted once, and a second one is waited for.
        if self.doubted.is_some_and(|(version, ..)| version == map.version()) {
            return None;
        }
        let known_cells = self.census.update(&map.grid, &map.changes).known();
        if let Some(believed) = &self.believed
            && let Some(why) = doubt(believed, map, known_cells)
        {
            let resolution_m = map.grid.info().resolution_m();
            let agrees = self.doubted.is_some_and(|(_, cells, resolution)| {
                cells.abs_diff(known_cells) * 10 <= cells.max(known_cells) && resolution == resolution_m
            });
            if !agrees {
                self.doubted = Some((map.version(), known_cells, resolution_m));
                return Some(format!("{why}: a second map like it is waited for"));
            }
        }
        self.doubted = None;
        self.believed = Some(Believed { map: map.clone(), known_cells });
        (self.moved_m, self.turned_rad, self.due_since_s) = (0.0, 0.0, None);
        None
    }

    fn follow(&mut self, pose: &Pose, now_s: f64) {
        let view = *self.view.get_or_insert(*pose);
        if pose.distance_to(view.position()) >= STILL_M || shortest_angle(view.yaw, pose.yaw).abs() >= self.new_view_rad
        {
            self.view = Some(*pose);
            self.moved_at_version = self.version();
        }
        let anchor = *self.anchor.get_or_insert(*pose);
        let (moved_m, turned_rad) = (pose.distance_to(anchor.position()), shortest_angle(anchor.yaw, pose.yaw).abs());
        if moved_m < STILL_M && turned_rad < STILL_RAD {
            return;
        }
        self.anchor = Some(*pose);
        self.moved_m += moved_m;
        self.turned_rad += turned_rad;
        if self.moved_m >= DUE_M || self.turned_rad >= DUE_RAD {
            self.due_since_s.get_or_insert(now_s);
        }
    }
}

/// Why a map is not to be believed at once after the last one.
fn doubt(believed: &Believed, map: &MapSnapshot, known_cells: usize) -> Option<String> {
    let (old, new) = (believed.map.grid.info().resolution_m(), map.grid.info().resolution_m());
    if (old - new).abs() > SAME_RESOLUTION * old {
        return Some(format!("a map with cells of {new:.3} m came after one with cells of {old:.3} m"));
    }
    let (old, new) = (believed.known_cells, known_cells);
    let is_less = (new as f64) < LEAST_SHARE * old as f64;
    is_less.then(|| format!("a map came that knows {new} cells, and the last one knew {old}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::{GridInfo, OccupancyGrid};
    use std::sync::Arc;

    fn map(version: u64, known: usize, resolution_m: f64) -> MapSnapshot {
        let info = GridInfo::new(10, 10, resolution_m, Pose::default()).unwrap();
        let data = (0..100).map(|i| if i < known { 0 } else { -1 }).collect();
        // Stamps of today, in which a nanosecond vanishes.
        let grid = Arc::new(OccupancyGrid::new(info, data).unwrap());
        MapSnapshot::alone(1.8e9, version, grid)
    }

    fn watch(field_of_view_rad: f64) -> MapWatch {
        MapWatch::new(&Sight { range_m: 8.0, field_of_view_rad, heading_rad: 0.0 })
    }

    fn version(watch: &MapWatch) -> u64 {
        watch.map().unwrap().version()
    }

    #[test]
    fn a_map_is_fresh_when_it_came_after_the_last_motion() {
        let mut watch = watch(6.3);
        let (here, there) = (Pose::default(), Pose::new(0.3, 0.0, 0.0));
        watch.update(Some(&map(1, 50, 0.1)), Some(&here), 0.0);
        assert!(watch.is_fresh());
        watch.update(Some(&map(1, 50, 0.1)), Some(&there), 1.0);
        assert!(!watch.is_fresh());
        watch.update(Some(&map(1, 50, 0.1)), Some(&Pose::new(0.31, 0.0, 0.02)), 9.0);
        assert!(!watch.is_fresh(), "time alone makes no map newer");
        watch.update(Some(&map(2, 60, 0.1)), Some(&there), 10.0);
        assert!(watch.is_fresh());
    }

    #[test]
    fn a_turn_shows_something_new_to_a_narrow_view_alone() {
        for (field_of_view_rad, still_fresh) in [(6.3, true), (1.0, false)] {
            let mut watch = watch(field_of_view_rad);
            watch.update(Some(&map(1, 50, 0.1)), Some(&Pose::default()), 0.0);
            watch.update(None, Some(&Pose::new(0.0, 0.0, 0.4)), 1.0);
            assert!(watch.is_fresh(), "a small turn");
            watch.update(None, Some(&Pose::new(0.0, 0.0, 0.8)), 2.0);
            assert_eq!(watch.is_fresh(), still_fresh);
        }
    }

    #[test]
    fn a_map_is_due_after_motion_and_not_at_rest() {
        let mut watch = watch(6.3);
        watch.update(Some(&map(1, 50, 0.1)), Some(&Pose::default()), 0.0);
        watch.update(None, Some(&Pose::new(0.9, 0.0, 0.0)), 10.0);
        assert_eq!(watch.overdue_s(100.0), 0.0);
        watch.update(None, Some(&Pose::new(1.8, 0.0, 0.0)), 100.0);
        assert_eq!(watch.overdue_s(130.0), 30.0);
        watch.update(Some(&map(2, 50, 0.1)), Some(&Pose::new(1.8, 0.0, 0.0)), 131.0);
        assert_eq!(watch.overdue_s(200.0), 0.0);
    }

    #[test]
    fn one_bad_map_among_good_ones_is_passed_over_and_two_are_believed() {
        let mut watch = watch(6.3);
        assert_eq!(watch.update(Some(&map(1, 80, 0.1)), None, 0.0), None);
        let notice = watch.update(Some(&map(2, 5, 0.1)), None, 1.0).unwrap();
        assert!(notice.contains("knows 5 cells"), "{notice}");
        assert_eq!(version(&watch), 1);
        watch.update(Some(&map(2, 5, 0.1)), None, 1.5);
        assert_eq!(version(&watch), 1, "the same map again is no second one");
        watch.update(Some(&map(3, 81, 0.1)), None, 2.0);
        assert_eq!(version(&watch), 3);
        assert!(watch.update(Some(&map(4, 81, 0.2)), None, 3.0).unwrap().contains("cells of 0.200 m"));
        assert_eq!(version(&watch), 3);
        watch.update(Some(&map(5, 80, 0.2)), None, 4.0);
        assert_eq!(version(&watch), 5);
    }
}
