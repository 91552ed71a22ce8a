//! From the end of a run to `run.json`, for simulated runs and replays alike.

use super::Trail;
use crate::explore::{End, Explorer};
use crate::geometry::Pose;
use crate::grid::{Census, OccupancyGrid};
use crate::report::{RunRecord, SCHEMA_VERSION, Series};

/// What the robot and its settings tell of a run that is over; the explorer and the trail
/// tell the rest.
#[derive(Default)]
pub(super) struct Outcome<'a> {
    /// Name of the world, or of what stands for it.
    pub world: &'a str,
    /// Name of the preset.
    pub preset: &'a str,
    /// Name of the robot.
    pub robot: &'a str,
    /// The seed, if there was chance.
    pub seed: Option<u64>,
    /// The SLAM, if it was simulated and not the perfect one.
    pub slam: Option<String>,
    /// Where the robot began.
    pub start: Pose,
    /// Share that was covered, 0 to 1.
    pub coverage: f64,
    /// The robot's own time, seconds.
    pub sim_time_s: f64,
    /// Way driven, metres.
    pub distance_m: f64,
    /// All turning, radians.
    pub turned_rad: f64,
    /// Contacts with what is solid.
    pub collisions: usize,
    /// The last map and its cells, counted by the preset's thresholds.
    pub map: Option<(&'a OccupancyGrid, Census)>,
}

impl Outcome<'_> {
    /// The run as `run.json` holds it; it took `total_s` seconds of real time. Notices and
    /// decisions leave the trail.
    pub fn record(self, explorer: &Explorer, end: &End, series: &Series, trail: &mut Trail, total_s: f64) -> RunRecord {
        let counts = *explorer.counts();
        let area_m2 = |cells: fn(&Census) -> usize| {
            self.map.as_ref().map_or(0.0, |(grid, census)| cells(census) as f64 * grid.info().cell_area_m2())
        };
        RunRecord {
            schema_version: SCHEMA_VERSION,
            known_area_m2: area_m2(Census::known),
            free_area_m2: area_m2(|census| census.free),
            world: self.world.to_owned(),
            preset: self.preset.to_owned(),
            robot: self.robot.to_owned(),
            seed: self.seed,
            slam: self.slam,
            start: self.start,
            end_reason: end.reason,
            end_message: end.message.clone(),
            coverage: self.coverage,
            sim_time_s: self.sim_time_s,
            distance_m: self.distance_m,
            turned_rad: self.turned_rad,
            goals_sent: counts.goals_sent,
            goals_failed: counts.goals_failed,
            collisions: self.collisions,
            time_to_coverage_s: series.time_to_coverage_s(),
            distance_to_coverage_m: series.distance_to_coverage_m(),
            counts,
            time_spent: *explorer.time_spent(),
            notices: std::mem::take(&mut trail.notices),
            left_behind: end.left_behind,
            decisions: std::mem::take(&mut trail.decisions),
            series: series.points(),
            wall: trail.wall(total_s),
        }
    }
}
