//! Autonomous frontier exploration for ROS 1 robots.
//!
//! One pipeline, written once, runs in a simulator, on bags and on a robot: an
//! occupancy grid goes in, frontiers are detected, a goal is chosen, the robot drives
//! there, and at the end a map_server map is saved. `ARCHITECTURE.md` shows the floors, and
//! `docs/settings.md` explains every setting.
//!
//! # What is here
//!
//! Data:
//! - [`geometry`]: poses, twists, polygons, footprints.
//! - [`grid`]: occupancy grids, costmaps, distances; cells in the world.
//! - [`bits`]: planes of one bit a cell, and what is connected in them.
//! - [`tf`]: frames over time, and transforms between them.
//! - [`scan`]: lidar sweeps.
//! - [`range`]: numbers that must lie in a range.
//!
//! Algorithms:
//! - [`frontier`]: the detectors, by [`DetectorKind`](frontier::DetectorKind).
//! - [`selection`]: which frontier next, by [`SelectorConfig`](selection::SelectorConfig).
//! - [`planning`]: paths over costmaps, by [`PlannerConfig`](planning::PlannerConfig).
//! - [`control`]: from paths to velocities, by [`ControllerConfig`](control::ControllerConfig).
//!
//! The pipeline:
//! - [`robot`]: the port, [`Robot`](robot::Robot), behind which simulators, bags and robots stand.
//! - [`explore`]: the state machine, [`Explorer`](explore::Explorer), and the loop that drives it.
//! - [`navigation`]: driving to goals with our own planner and controller.
//! - [`config`]: presets and robots, from YAML to validated types.
//!
//! Around it:
//! - [`io`]: map_server maps and the built-in worlds.
//! - [`sim`]: the simulated robot, [`SimRobot`](sim::SimRobot).
//! - [`bag`]: recordings, read and written without ROS.
//! - [`replay`]: a recording behind the port.
//! - [`mapping`]: a map made of scans and odometry.
//! - `report`, with the feature of that name: pictures, `run.json`, the HTML page.
//! - `ros`, with the feature of that name: the ROS 1 adapter, a robot behind topics.
//! - [`run`]: what assembles, drives and records runs, one or many.
//! - `nodes`, with the feature `ros`: `explore_node` and `sim_node`.
//!
//! # Frontiers on a map
//!
//! ```
//! use frontier_explorer::frontier::{DetectionInput, DetectorKind, DetectorParams, Representative};
//! use frontier_explorer::geometry::{Point, Pose};
//! use frontier_explorer::grid::OccupancyGrid;
//!
//! // A room with a door on the right, in cells of 1 m; the robot stands in the middle.
//! let drawing = ["#####?", "#...#?", "#....?", "#...#?", "#####?"].join("\n");
//! let map = OccupancyGrid::from_ascii(&drawing).unwrap();
//! let robot = Pose::new(2.5, 2.5, 0.0);
//! let mut detector = DetectorKind::Bitplane.build(&DetectorParams::default());
//! let frontiers = detector.detect(&DetectionInput::new(&map, robot))?;
//! assert_eq!((frontiers.len(), frontiers[0].size_m(map.info())), (1, 3.0));
//! let goal = Representative::Median.of(&frontiers[0], map.info(), robot.position());
//! assert_eq!(goal, Point::new(5.5, 2.5));
//! # Ok::<(), frontier_explorer::frontier::DetectError>(())
//! ```
//!
//! # One step of the explorer
//!
//! An [`Explorer`](explore::Explorer) is handed what is known, time included, and says what to do.
//!
//! ```
//! use frontier_explorer::config::{Preset, builtin_robot};
//! use frontier_explorer::explore::Explorer;
//! use frontier_explorer::geometry::Pose;
//! use frontier_explorer::grid::OccupancyGrid;
//! use frontier_explorer::robot::{Command, MapSnapshot, Navigation, NavigationState, Observation};
//! use std::sync::Arc;
//!
//! let preset = Preset::built_in("wfd_360")?;
//! let mut explorer = Explorer::new(preset.explorer, &builtin_robot("turtlebot2")?.traits())?;
//! let map = OccupancyGrid::from_ascii(&["#.......????"; 8].join("\n")).unwrap();
//! let decision = explorer.step(&Observation {
//!     stamp_s: 0.0,
//!     pose_in_map: Ok(Pose::new(2.5, 4.5, 0.0)),
//!     map: Some(MapSnapshot::alone(0.0, 1, Arc::new(map))),
//!     scan: None,
//!     navigation: Navigation { command: 0, state: NavigationState::Idle },
//! });
//! let Command::Drive { goal_in_map, .. } = decision.command else { panic!("{:?}", decision.command) };
//! assert!(goal_in_map.x > 5.0, "the unknown begins at x = 8 m");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # A simulated run
//!
//! ```
//! use frontier_explorer::config::{Preset, builtin_robot};
//! use frontier_explorer::explore::{EndReason, Explorer, run};
//! # use frontier_explorer::geometry::Pose;
//! # use frontier_explorer::grid::{GridInfo, OccupancyGrid, Thresholds};
//! use frontier_explorer::sim::{SimConfig, SimRobot, World};
//! use std::sync::Arc;
//! # // Two rooms with a door of 1 m.
//! # let drawing = OccupancyGrid::from_ascii(&[
//! #     &["##################"][..], &["#.......#........#"; 3], &["#................#"; 2],
//! #     &["#.......#........#"; 3], &["##################"],
//! # ].concat().join("\n")).unwrap();
//! # let truth = OccupancyGrid::new(GridInfo::new(18, 10, 0.5, Pose::default())?, drawing.data().to_vec())?;
//!
//! let (preset, robot) = (Preset::built_in("wfd_360")?, builtin_robot("turtlebot2")?);
//! let navigator = preset.navigator(&robot.body());
//! let world = Arc::new(World::new(&truth, &Thresholds::default())?);
//! let mut sim = SimRobot::new(world, &robot, SimConfig::default(), navigator, Pose::new(2.0, 1.5, 0.0))?;
//! let mut explorer = Explorer::new(preset.explorer, &robot.traits())?;
//! let end = run(&mut sim, &mut explorer, &mut ());
//! assert_eq!(end.reason, EndReason::Complete);
//! assert!(sim.stats().distance_m > 1.0 && explorer.counts().goals_sent > 0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Reading a bag
//!
//! ```
//! use frontier_explorer::bag::{MessageType, Playback, Summary, map, open_bag};
//! use std::fs::File;
//! use std::path::Path;
//!
//! let path = Path::new("bags/office.bag");
//! let mut reader = open_bag(path, File::open(path)?)?;
//! let summary = Summary::of(reader.as_mut())?;
//! let topic = &summary.topics_of(MessageType::Map)[0].topic;
//! let mut playback = Playback::new(reader, &summary);
//! let mut cells = Vec::new();
//! while let Some(message) = playback.next_message()? {
//!     if message.connection.topic == *topic {
//!         cells.push(map(message.data)?.grid.info().len());
//!     }
//! }
//! assert!(cells.len() > 1 && cells.last() >= cells.first(), "maps only grow: {cells:?}");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod bag;
pub mod bits;
pub mod config;
pub mod control;
pub mod explore;
pub mod frontier;
pub mod geometry;
pub mod grid;
pub mod io;
pub mod mapping;
pub(crate) mod matching;
pub mod navigation;
#[cfg(feature = "ros")]
pub mod nodes;
pub mod planning;
pub mod range;
pub mod replay;
#[cfg(feature = "report")]
pub mod report;
pub mod robot;
#[cfg(feature = "ros")]
pub mod ros;
pub mod run;
pub mod scan;
pub mod selection;
pub mod sim;
pub mod text;
pub mod tf;
