//! What a robot with gmapping publishes: scans, odometry, transforms, the map, and the
//! clock.

use crate::config::RobotConfig;
use crate::geometry::{Pose, Twist};
use crate::grid::OccupancyGrid;
use crate::ros::msg::geometry_msgs::{
    PoseWithCovariance, Transform, TransformStamped, Twist as TwistMessage, TwistWithCovariance, Vector3,
};
use crate::ros::msg::nav_msgs::{
    GetMap, GetMapRes, MapMetaData, OccupancyGrid as GridMessage, Odometry as OdometryMessage,
};
use crate::ros::msg::rosgraph_msgs::Clock;
use crate::ros::msg::sensor_msgs::LaserScan as ScanMessage;
use crate::ros::msg::tf2_msgs::TFMessage;
use crate::ros::{Node, NodeError, Publisher, Service, convert};
use crate::sim::Plant;

use std::sync::{Arc, Mutex, PoisonError};

const MAP: &str = "map";
const ODOM: &str = "odom";
const SCAN: &str = "base_scan";

/// A map, and the ROS time in seconds at which it was told.
type Told = (Arc<OccupancyGrid>, f64);

/// The topics of the simulated robot.
pub struct Topics {
    scan: Publisher<ScanMessage>,
    odometry: Publisher<OdometryMessage>,
    tf: Publisher<TFMessage>,
    map: Publisher<GridMessage>,
    meta: Publisher<MapMetaData>,
    cmd_vel: Publisher<TwistMessage>,
    clock: Option<Publisher<Clock>>,
    base_frame: String,
    scan_period_s: f64,
    newest: Arc<Mutex<Option<Told>>>,
    _tf_static: Publisher<TFMessage>,
    _dynamic_map: Service,
}

impl Topics {
    /// Offers the topics; what is fixed is told once.
    ///
    /// # Errors
    /// [`NodeError`] when something cannot be offered.
    pub fn offer(node: &Node, robot: &RobotConfig, base_frame: &str, with_clock: bool) -> Result<Self, NodeError> {
        let newest = Arc::<Mutex<Option<Told>>>::default();
        let theirs = Arc::clone(&newest);
        let dynamic_map = node.serve::<GetMap>("dynamic_map", move |_| {
            let newest = theirs.lock().unwrap_or_else(PoisonError::into_inner).clone();
            let (grid, stamp_s) = newest.ok_or("no map yet")?;
            Ok(GetMapRes { map: convert::grid_message(&grid, MAP, stamp_s) })
        })?;
        let tf_static = node.publish_latched("/tf_static")?;
        let mount = transform(base_frame, SCAN, &robot.lidar.mount, node.now_s());
        let footprint = transform(base_frame, "base_footprint", &Pose::default(), node.now_s());
        let mut transforms = vec![mount];
        if base_frame != "base_footprint" {
            transforms.push(footprint);
        }
        let _ = tf_static.send(TFMessage { transforms });
        Ok(Self {
            scan: node.publish("scan", 5)?,
            odometry: node.publish("odom", 10)?,
            tf: node.publish("/tf", 50)?,
            map: node.publish_latched("map")?,
            meta: node.publish_latched("map_metadata")?,
            cmd_vel: node.publish("cmd_vel", 5)?,
            clock: if with_clock { Some(node.publish("/clock", 10)?) } else { None },
            base_frame: base_frame.to_owned(),
            scan_period_s: 1.0 / robot.lidar.rate_hz,
            newest,
            _tf_static: tf_static,
            _dynamic_map: dynamic_map,
        })
    }

    /// Tells the time.
    pub fn tell_clock(&self, stamp_s: f64) {
        if let Some(clock) = &self.clock {
            let _ = clock.send(Clock { clock: convert::time(stamp_s) });
        }
    }

    /// Tells the newest scan, taken at a time.
    pub fn tell_scan(&self, plant: &Plant, stamp_s: f64) {
        let mut message = convert::scan_message(plant.scan().1, SCAN, self.scan_period_s);
        message.header.stamp = convert::time(stamp_s);
        let _ = self.scan.send(message);
    }

    /// Tells odometry, and the frames unless they are held back.
    pub fn tell_odometry(&self, plant: &Plant, stamp_s: f64, with_tf: bool) {
        let in_odom = plant.pose_in_odom();
        let twist = convert::twist_message(&plant.twist());
        let _ = self.odometry.send(OdometryMessage {
            header: convert::header(ODOM, stamp_s),
            child_frame_id: self.base_frame.clone(),
            pose: PoseWithCovariance { pose: convert::pose_message(&in_odom), covariance: [0.0; 36] },
            twist: TwistWithCovariance { twist, covariance: [0.0; 36] },
        });
        if with_tf {
            // What is known late is stamped by when it was true.
            let known_s = stamp_s - plant.pose_lateness_s();
            let transforms = vec![
                transform(MAP, ODOM, &plant.map_from_odom(), known_s),
                transform(ODOM, &self.base_frame, &in_odom, stamp_s),
            ];
            let _ = self.tf.send(TFMessage { transforms });
        }
    }

    /// Tells the map.
    pub fn tell_map(&self, plant: &Plant, stamp_s: f64) {
        let message = convert::grid_message(plant.map(), MAP, stamp_s);
        let _ = self.meta.send(message.info.clone());
        let _ = self.map.send(message);
        let newest = (Arc::clone(plant.map()), stamp_s);
        *self.newest.lock().unwrap_or_else(PoisonError::into_inner) = Some(newest);
    }

    /// Tells what move_base's stand-in commands, for those who look on.
    pub fn tell_command(&self, twist: &Twist) {
        let _ = self.cmd_vel.send(convert::twist_message(twist));
    }
}

fn transform(parent: &str, child: &str, pose: &Pose, stamp_s: f64) -> TransformStamped {
    TransformStamped {
        header: convert::header(parent, stamp_s),
        child_frame_id: child.to_owned(),
        transform: Transform {
            translation: Vector3 { x: pose.x, y: pose.y, z: 0.0 },
            rotation: convert::quaternion(pose.yaw),
        },
    }
}
