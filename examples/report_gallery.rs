//! Draws every picture of a report from a made-up run, to look at them:
//! `cargo run --release --example report_gallery -- <directory> [columns] [rows]`.

use frontier_explorer::explore::{
    CandidateRecord, CandidateStatus, Counts, DecisionRecord, EndReason, LeftBehind, Position, TimeSpent,
};
use frontier_explorer::geometry::{Point, Pose};
use frontier_explorer::grid::{Cell, GridInfo, NEIGHBOURS_4, OccupancyGrid, Thresholds, traverse};
use frontier_explorer::report::{
    Animation, Frame, FrameLog, HtmlReport, MedianMax, Overlay, OverlayFrontier, Picture, PictureGoal, RunRecord,
    SCHEMA_VERSION, Series, Theme, Wall,
};
use std::collections::BTreeMap;
use std::error::Error;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

/// Edge length of a cell, metres.
const RESOLUTION_M: f64 = 0.05;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let directory = PathBuf::from(arguments.next().unwrap_or_else(|| "/tmp/gallery".to_owned()));
    let columns: u32 = arguments.next().map_or(Ok(1200), |text| text.parse())?;
    let rows: u32 = arguments.next().map_or(Ok(800), |text| text.parse())?;
    std::fs::create_dir_all(&directory)?;

    let world = rooms(columns, rows)?;
    let thresholds = Thresholds::default();
    let run = drive(&world);
    let last = run.log.frames().last().ok_or("the run has no frames")?;

    let clock = Instant::now();
    let gif = Animation { thresholds: &thresholds, trajectory: &run.trajectory, theme: Theme::Clear }
        .to_gif(run.log.frames())?;
    let gif_s = clock.elapsed().as_secs_f64();
    std::fs::write(directory.join("run.gif"), &gif)?;

    let clock = Instant::now();
    let png = Picture {
        grid: &last.grid,
        thresholds: &thresholds,
        trajectory: &run.trajectory,
        start_in_map: run.trajectory.first().map(|p| Pose::new(p.x, p.y, 0.0)),
        end_in_map: last.pose_in_map,
        goals: &run.goals,
        region: None,
        no_go: &[],
        theme: Theme::Clear,
    }
    .to_png()?;
    let png_s = clock.elapsed().as_secs_f64();
    std::fs::write(directory.join("map.png"), &png)?;

    let middle = run.log.frames().nth(run.log.len() / 2).ok_or("the run has no frames")?;
    let cells: Vec<Cell> = middle.frontier_points_in_map.iter().map(|&p| middle.grid.info().cell_at(p)).collect();
    let (taboo, open) = cells.split_at(cells.len() / 5);
    let frontiers = [
        OverlayFrontier { cells: taboo, goal: taboo.first().map(|&c| middle.grid.info().center(c)), taboo: true },
        OverlayFrontier { cells: open, goal: middle.goal_in_map, taboo: false },
    ];
    for theme in Theme::ALL {
        let overlay = Overlay {
            grid: &middle.grid,
            thresholds: &thresholds,
            frontiers: &frontiers,
            robot_in_map: middle.pose_in_map,
            region: None,
            no_go: &[],
            theme,
        };
        std::fs::write(directory.join(format!("overlay-{}.png", theme.name())), overlay.to_png()?)?;
    }

    let record = record(&run);
    std::fs::write(directory.join("run.json"), record.to_json()?)?;
    let report =
        HtmlReport { run: &record, map_png: &png, animation_gif: Some(&gif), theme: Theme::Clear, beside: None };
    let html = report.to_html()?;
    std::fs::write(directory.join("report.html"), &html)?;
    let figures = format!(
        "gif {gif_s:.3} s, {} bytes, {} frames; png {png_s:.3} s, {} bytes; html {} bytes\n",
        gif.len(),
        run.log.len(),
        png.len(),
        html.len()
    );
    std::fs::write(directory.join("figures.txt"), figures)?;
    Ok(())
}

/// What the made-up run left.
struct Run {
    log: FrameLog,
    trajectory: Vec<Point>,
    goals: Vec<PictureGoal>,
    series: Series,
    distance_m: f64,
    time_s: f64,
}

/// A building of rooms with doors.
fn rooms(columns: u32, rows: u32) -> Result<OccupancyGrid, Box<dyn Error>> {
    let info = GridInfo::new(columns, rows, RESOLUTION_M, Pose::new(-5.0, -3.0, 0.0))?;
    let mut world = OccupancyGrid::filled(info, OccupancyGrid::FREE);
    let (columns, rows) = (columns as i32, rows as i32);
    for y in 0..rows {
        for x in 0..columns {
            let outer = x < 2 || y < 2 || x >= columns - 2 || y >= rows - 2;
            let wall_x = x % 150 == 0 && (y % 200 < 60 || y % 200 > 110);
            let wall_y = y % 200 == 0 && (x % 150 < 40 || x % 150 > 80);
            let shelf = (x % 150 - 110).abs() < 14 && (y % 200 - 140).abs() < 6;
            if outer || wall_x || wall_y || shelf {
                world.set(Cell::new(x, y), OccupancyGrid::OCCUPIED);
            }
        }
    }
    Ok(world)
}

/// Drives back and forth through the rooms and maps what is seen within 6 m.
fn drive(world: &OccupancyGrid) -> Run {
    let info = *world.info();
    let mut map = OccupancyGrid::filled(info, OccupancyGrid::UNKNOWN);
    let mut run = Run {
        log: FrameLog::default(),
        trajectory: Vec::new(),
        goals: Vec::new(),
        series: Series::new(),
        distance_m: 0.0,
        time_s: 0.0,
    };
    let free = world.census(&Thresholds::default()).known() as f64;
    let (columns, rows) = (info.width() as i32, info.height() as i32);
    let mut way: Vec<Point> = Vec::new();
    for (i, y) in (85..rows).step_by(200).enumerate() {
        let ends = [Cell::new(60, y), Cell::new(columns - 20, y)];
        let ends = if i % 2 == 0 { ends } else { [ends[1], ends[0]] };
        way.extend(ends.map(|cell| info.center(cell)));
    }
    for pair in way.windows(2) {
        let [from, to] = *pair else { continue };
        let pose = Pose::facing(from, to);
        let length_m = (to - from).norm();
        let steps = (length_m / 0.1).ceil();
        for step in 0..steps as u32 {
            let share = f64::from(step) / steps;
            let wobble = 0.4 * (share * length_m).sin();
            let here = from + (to - from) * share;
            let here = Point::new(here.x - wobble * pose.yaw.sin(), here.y + wobble * pose.yaw.cos());
            run.distance_m += run.trajectory.last().map_or(0.0, |last| (here - last).norm());
            run.trajectory.push(here);
            if step % 5 == 0 {
                look(world, &mut map, here);
            }
            let known = map.census(&Thresholds::default()).known() as f64;
            run.series.push(run.time_s, known / free, run.distance_m);
            let last = step + 1 == steps as u32;
            if run.log.wants(run.time_s) || last {
                run.log.push(Frame {
                    time_s: run.time_s,
                    grid: Arc::new(map.clone()),
                    pose_in_map: Some(Pose::new(here.x, here.y, pose.yaw + 0.4 * (share * length_m).cos())),
                    trajectory_len: run.trajectory.len(),
                    frontier_points_in_map: frontier(&map).into(),
                    goal_in_map: Some(to),
                });
            }
            run.time_s += 0.2;
        }
        run.goals.push(PictureGoal { point_in_map: to, failed: run.goals.len() % 3 == 2 });
    }
    run
}

/// Marks what a lidar sees from a point.
fn look(world: &OccupancyGrid, map: &mut OccupancyGrid, from: Point) {
    for beam in 0..720 {
        let heading = f64::from(beam) * std::f64::consts::TAU / 720.0;
        for (cell, _) in traverse(world.info(), from, heading, 6.0) {
            let Some(value) = world.get(cell) else { break };
            map.set(cell, value);
            if value == OccupancyGrid::OCCUPIED {
                break;
            }
        }
    }
}

/// Free cells beside unknown ones.
fn frontier(map: &OccupancyGrid) -> Vec<Point> {
    let info = map.info();
    let cells = (0..info.len()).map(|i| info.cell(i)).filter(|&cell| {
        map.get(cell) == Some(OccupancyGrid::FREE)
            && NEIGHBOURS_4.iter().any(|&offset| map.get(cell.offset(offset)) == Some(OccupancyGrid::UNKNOWN))
    });
    cells.map(|cell| info.center(cell)).collect()
}

/// The record of the run with some decisions.
fn record(run: &Run) -> RunRecord {
    let start = run.trajectory.first().copied().unwrap_or(Point::origin());
    let decisions = run.goals.iter().enumerate().map(|(i, goal)| {
        let at = goal.point_in_map;
        let goal = Pose::new(at.x, at.y, 0.3);
        DecisionRecord {
            time_s: 31.4 * i as f64,
            pose: Pose::new(start.x, start.y, 0.0),
            candidates: (0..(i as u64 * 7 + 2))
                .map(|id| CandidateRecord {
                    id,
                    target: Position { x: at.x + id as f64 * 0.7, y: at.y },
                    goal: (id % 3 != 2).then_some(goal),
                    size_cells: 20 + id as usize,
                    size_m: (20 + id) as f64 * RESOLUTION_M,
                    distance_m: 2.0 + id as f64 * 1.3,
                    path_m: (id % 3 != 2).then_some(2.4 + id as f64 * 1.5),
                    scores: BTreeMap::from([("distance", 2.0 + id as f64), ("gain", -1.25), ("total", id as f64)]),
                    status: match id {
                        0 => CandidateStatus::Chosen,
                        _ if id % 3 == 2 => CandidateStatus::NoPath,
                        _ => CandidateStatus::Eligible,
                    },
                })
                .collect(),
            goal: Some(goal),
            why: format!("frontier 0 has the lowest score of {} that can be reached", i * 7 + 2),
        }
    });
    RunRecord {
        schema_version: SCHEMA_VERSION,
        world: "made-up rooms".to_owned(),
        preset: "default".to_owned(),
        robot: "turtlebot3_waffle".to_owned(),
        seed: Some(42),
        slam: None,
        start: Pose::new(start.x, start.y, 0.0),
        end_reason: EndReason::Complete,
        end_message: "No frontier is left that the robot could get to.".to_owned(),
        coverage: run.series.points().last().map_or(0.0, |point| point.coverage),
        sim_time_s: run.time_s,
        distance_m: run.distance_m,
        turned_rad: 52.5,
        goals_sent: run.goals.len(),
        goals_failed: 2,
        collisions: 0,
        known_area_m2: 2205.4,
        free_area_m2: 2031.9,
        time_to_coverage_s: run.series.time_to_coverage_s(),
        distance_to_coverage_m: run.series.distance_to_coverage_m(),
        counts: Counts { goals_sent: run.goals.len(), goals_reached: 5, detections: 211, ..Counts::default() },
        time_spent: TimeSpent::default(),
        notices: Vec::new(),
        left_behind: LeftBehind { frontiers: 3, unreachable: 2, failed: 1, ..LeftBehind::default() },
        decisions: decisions.collect(),
        series: run.series.points(),
        wall: Wall { total_s: 1.0, decision_ms: MedianMax { median: 0.7, max: 3.0 } },
    }
}
