//! `frontier map diff`: two maps of one place, compared by where things are.
//!
//! Both are looked at in the centres of the first map's cells, continued beyond its
//! edges until they cover the second; outside a map is unknown. Maps of other sizes,
//! origins and headings can so be compared, of other resolutions not.

use super::picture;
use crate::exit::Outcome;
use crate::output;
use anyhow::{Context, ensure};
use frontier_explorer::geometry::Pose;
use frontier_explorer::grid::{CellState, GridInfo, OccupancyGrid, Thresholds};
use frontier_explorer::io::load_map;
use serde::Serialize;
use std::path::PathBuf;

/// Arguments of `frontier map diff`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The YAML file of the first map.
    a: PathBuf,
    /// The YAML file of the second map.
    b: PathBuf,
    /// Print JSON.
    #[arg(long)]
    json: bool,
    /// Draw the comparison as a PNG: red is free in A and occupied in B, blue the other
    /// way round, orange is known only in A, green only in B.
    #[arg(long, value_name = "OUT.png")]
    picture: Option<PathBuf>,
}

/// What both maps say, in cells; with `--json`, these are the keys.
#[derive(Debug, Default, PartialEq, Serialize)]
pub struct Report {
    /// Free in both.
    both_free: usize,
    /// Occupied in both.
    both_occupied: usize,
    /// Free in A, occupied in B.
    free_to_occupied: usize,
    /// Occupied in A, free in B.
    occupied_to_free: usize,
    /// Known in A alone.
    known_only_in_a: usize,
    /// Known in B alone.
    known_only_in_b: usize,
    /// Of the cells known in both, those that agree; none when no cell is.
    agreement_percent: Option<f64>,
}

impl Report {
    fn add(&mut self, a: CellState, b: CellState) {
        use CellState::{Free, Occupied, Unknown, Unsettled};
        match (a, b) {
            (Free, Free) => self.both_free += 1,
            (Occupied, Occupied) => self.both_occupied += 1,
            (Free, Occupied) => self.free_to_occupied += 1,
            (Occupied, Free) => self.occupied_to_free += 1,
            (Unknown | Unsettled, Unknown | Unsettled) => {}
            (_, Unknown | Unsettled) => self.known_only_in_a += 1,
            (Unknown | Unsettled, _) => self.known_only_in_b += 1,
        }
    }

    fn finish(mut self) -> Self {
        let agreeing = self.both_free + self.both_occupied;
        let known = agreeing + self.free_to_occupied + self.occupied_to_free;
        self.agreement_percent = (known > 0).then(|| 100.0 * agreeing as f64 / known as f64);
        self
    }

    const fn differs(&self) -> bool {
        self.free_to_occupied + self.occupied_to_free + self.known_only_in_a + self.known_only_in_b > 0
    }
}

/// The first map's raster, continued to cover the second.
fn common_raster(a: &GridInfo, b: &GridInfo) -> anyhow::Result<GridInfo> {
    let (wide, high) = (b.width() as f64, b.height() as f64);
    let corners =
        [(0.0, 0.0), (wide, 0.0), (0.0, high), (wide, high)].map(|(x, y)| a.to_grid_units(b.from_grid_units(x, y)));
    // The rounding of the world coordinates must not add a column of its own.
    let (low, up) = (|v: f64| (v + 1e-6).floor(), |v: f64| (v - 1e-6).ceil());
    let first = corners.iter().fold((0.0_f64, 0.0_f64), |f, c| (f.0.min(low(c.0)), f.1.min(low(c.1))));
    let size = (a.width() as f64, a.height() as f64);
    let last = corners.iter().fold(size, |l, c| (l.0.max(up(c.0)), l.1.max(up(c.1))));
    let corner = a.from_grid_units(first.0, first.1);
    let origin = Pose::new(corner.x, corner.y, a.origin_in_map().yaw);
    // A float beyond the range becomes the largest size, which the grid refuses.
    GridInfo::new((last.0 - first.0) as u32, (last.1 - first.1) as u32, a.resolution_m(), origin)
        .context("the maps lie too far apart to be compared")
}

/// Runs `frontier map diff`.
pub fn run(args: &Args) -> anyhow::Result<Outcome> {
    let (a, b) = (load_map(&args.a)?.grid, load_map(&args.b)?.grid);
    let (fine, coarse) = (a.info().resolution_m(), b.info().resolution_m());
    ensure!(
        (fine - coarse).abs() <= 1e-6 * fine,
        "{} has {fine} m per cell and {} has {coarse}: must be the same",
        args.a.display(),
        args.b.display()
    );
    let raster = common_raster(a.info(), b.info())?;
    let report = compare(&a, &b, &raster);
    if let Some(path) = &args.picture {
        picture::write(path, &raster, |index| states(&a, &b, &raster, index))?;
    }
    if args.json {
        output::json(&report)?;
    } else {
        print(&report)?;
    }
    Ok(if report.differs() { Outcome::Differs } else { Outcome::Done })
}

/// What both maps say of a cell of the common raster.
fn states(a: &OccupancyGrid, b: &OccupancyGrid, raster: &GridInfo, index: usize) -> (CellState, CellState) {
    let thresholds = Thresholds::default();
    let centre = raster.center(raster.cell(index));
    (a.state_at(centre, &thresholds), b.state_at(centre, &thresholds))
}

fn compare(a: &OccupancyGrid, b: &OccupancyGrid, raster: &GridInfo) -> Report {
    let mut report = Report::default();
    for index in 0..raster.len() {
        let (in_a, in_b) = states(a, b, raster, index);
        report.add(in_a, in_b);
    }
    report.finish()
}

fn print(report: &Report) -> anyhow::Result<()> {
    output::line(format_args!("free in both        {} cells", report.both_free))?;
    output::line(format_args!("occupied in both    {} cells", report.both_occupied))?;
    output::line(format_args!("free -> occupied    {} cells", report.free_to_occupied))?;
    output::line(format_args!("occupied -> free    {} cells", report.occupied_to_free))?;
    output::line(format_args!("known only in A     {} cells", report.known_only_in_a))?;
    output::line(format_args!("known only in B     {} cells", report.known_only_in_b))?;
    match report.agreement_percent {
        Some(percent) => output::line(format_args!("agreement           {percent:.3} % of what both know")),
        None => output::line(format_args!("agreement           none: no cell is known in both")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(a: &OccupancyGrid, b: &OccupancyGrid, expected: [usize; 6]) {
        let raster = common_raster(a.info(), b.info()).unwrap();
        let r = compare(a, b, &raster);
        let found = [
            r.both_free,
            r.both_occupied,
            r.free_to_occupied,
            r.occupied_to_free,
            r.known_only_in_a,
            r.known_only_in_b,
        ];
        assert_eq!(found, expected);
    }

    fn at(origin: Pose, drawing: &str) -> OccupancyGrid {
        let drawn = OccupancyGrid::from_ascii(drawing).unwrap();
        let info = GridInfo::new(drawn.info().width() as u32, drawn.info().height() as u32, 0.05, origin).unwrap();
        OccupancyGrid::new(info, drawn.data().to_vec()).unwrap()
    }

    #[test]
    fn each_kind_of_difference_is_counted() {
        let a = at(Pose::default(), "..##?.?");
        let b = at(Pose::default(), ".#.#.??");
        check(&a, &b, [1, 1, 1, 1, 1, 1]);
        check(&a, &a, [3, 2, 0, 0, 0, 0]);
    }

    #[test]
    fn a_map_that_grew_to_all_sides_is_compared_by_place() {
        let a = at(Pose::new(1.0, 2.0, 0.0), "#.\n..");
        let b = at(Pose::new(0.95, 1.95, 0.0), "????\n?#.?\n?..?\n????");
        check(&a, &b, [3, 1, 0, 0, 0, 0]);
        check(&b, &a, [3, 1, 0, 0, 0, 0]);
    }

    #[test]
    fn a_quarter_turn_is_seen_through() {
        let a = at(Pose::default(), "#.\n.?");
        // The same place with its axes turned: origin at a's lower right corner.
        let b = at(Pose::new(0.1, 0.0, std::f64::consts::FRAC_PI_2), "#.\n.?");
        let turned = at(Pose::new(0.1, 0.0, std::f64::consts::FRAC_PI_2), ".#\n?.");
        check(&a, &turned, [2, 1, 0, 0, 0, 0]);
        assert!(common_raster(a.info(), b.info()).unwrap() == *a.info());
    }

    #[test]
    fn maps_worlds_apart_are_refused() {
        let (a, b) = (at(Pose::default(), "."), at(Pose::new(1e8, 0.0, 0.0), "."));
        assert!(common_raster(a.info(), b.info()).is_err());
    }
}
