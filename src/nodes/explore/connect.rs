//! From settings to connections.

use super::settings::{ExploreNodeError, Settings};
use crate::config::{Drive, TurnBy};
use crate::frontier::DetectorKind;
use crate::grid::MapMemory;
use crate::ros::Node;
use crate::ros::bell::Bell;
use crate::ros::map_feed::{MapFeed, MapReader};
use crate::ros::move_base::MoveBase;
use crate::ros::pilot::{Pilot, PilotConfig};
use crate::ros::robot::{Connections, RosRobot, RosRobotConfig};
use crate::ros::robot_map::{CostmapFeed, RobotMap};
use crate::ros::scan_feed::ScanFeed;
use crate::ros::transforms::Transforms;
use crate::ros::troubles::Troubles;
use crate::ros::tuning::{Tuned, Tuning};
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex};

/// What the node shares with the robot that it is connected to.
pub struct Connected {
    /// The newest map.
    pub maps: MapReader,
    /// The frame of the map.
    pub map_frame: Arc<Mutex<String>>,
    /// What is known of the frames.
    pub transforms: Arc<Transforms>,
    /// Whether the exploration is to rest.
    pub paused: Arc<AtomicBool>,
    /// Rung when something has come.
    pub bell: Arc<Bell>,
    /// Whether no move_base is asked to drive.
    pub drives_itself: bool,
    /// What is wrong now.
    pub troubles: Troubles,
    /// What of the robot may change while it drives.
    pub tuning: Tuning,
    /// Cancels the goal under way, for the end of a node that hangs.
    pub cancel: Box<dyn FnOnce() + Send>,
}

/// Connects to the robot that the settings describe.
/// The map of an earlier session lies below those that come.
pub fn connect(
    node: &Node,
    settings: &Settings,
    earlier: Option<MapMemory>,
) -> Result<(RosRobot, Connected), ExploreNodeError> {
    let Settings { params, preset, robot } = settings;
    let (explorer, navigation) = (&preset.explorer, &preset.navigation);
    let bell = Arc::<Bell>::default();
    let transforms = Arc::new(Transforms::listen(node));
    let map = MapFeed::listen(node, &params.map_topic, &params.map_updates_topic, &bell);
    if let Some(earlier) = earlier {
        map.remember(earlier);
    }
    let drives_itself = navigation.drive == Drive::Internal;
    let costmap = costmap_feed(node, settings, &bell);
    let needs_scans = drives_itself || params.back_off || explorer.detector.name == DetectorKind::Fast;
    let scans = needs_scans.then(|| Arc::new(ScanFeed::listen(node, "scan")));
    let move_base = if drives_itself { None } else { Some(MoveBase::connect(node, &params.move_base, &bell)?) };
    let body = robot.body();
    let navigator = preset.navigator(&body);
    let tuning = Tuning::new(Tuned {
        transform_tolerance_s: params.transform_tolerance,
        yield_s: params.yield_to_others,
        clear_costmaps: params.clear_costmaps,
    });
    let pilot_config = PilotConfig {
        base_frame: params.base_frame.clone(),
        tuning: tuning.clone(),
        control_period_s: navigation.navigator.control_period_s,
        body,
        drives_to_goals: drives_itself,
    };
    let troubles = Troubles::new(node.log());
    let pilot = Pilot::start(node, pilot_config, navigator, Arc::clone(&transforms), scans.clone(), &troubles)?;
    let connected = Connected {
        maps: map.reader(),
        map_frame: Arc::default(),
        transforms: Arc::clone(&transforms),
        paused: Arc::default(),
        bell: Arc::clone(&bell),
        drives_itself,
        troubles: troubles.clone(),
        tuning: tuning.clone(),
        cancel: canceller(move_base.as_ref()),
    };
    let config = RosRobotConfig {
        base_frame: params.base_frame.clone(),
        tuning,
        tick_period_s: 1.0 / params.tick_rate,
        turn_by_goals: params.turn_by == TurnBy::MoveBase,
        back_off: params.back_off,
    };
    let parts = Connections {
        map: RobotMap::new(map, costmap, explorer.thresholds, robot.inflation()),
        transforms,
        scans,
        move_base,
        pilot,
        bell,
        map_frame: Arc::clone(&connected.map_frame),
        paused: Arc::clone(&connected.paused),
        troubles,
    };
    Ok((RosRobot::new(node, config, parts), connected))
}

/// The costmap that is planned on, or the server's own, which is looked at where it comes.
fn costmap_feed(node: &Node, settings: &Settings, bell: &Arc<Bell>) -> CostmapFeed {
    let params = &settings.params;
    let listen = |topic: &str, bell| MapFeed::listen(node, topic, &format!("{topic}_updates"), bell);
    let own = format!("{}/global_costmap/costmap", params.move_base);
    if !params.global_costmap_topic.is_empty() {
        CostmapFeed::PlannedOn(listen(&params.global_costmap_topic, bell))
    } else if params.believe_costmap && settings.preset.navigation.drive == Drive::MoveBase && params.map_topic != own {
        // It comes each second: no reason to wake up.
        CostmapFeed::Believed(listen(&own, &Arc::default()))
    } else {
        CostmapFeed::None
    }
}

fn canceller(move_base: Option<&MoveBase>) -> Box<dyn FnOnce() + Send> {
    match move_base {
        Some(server) => Box::new(server.canceller()),
        None => Box::new(|| ()),
    }
}
