//! Messages as they come over TCP: their bytes decoded by rosrust, and what takes them in.

use super::engine::{Answer, Target};
use super::exploring::sweep;
use frontier_explorer::geometry::{Point, Polygon, Pose};
use frontier_explorer::ros::msg::actionlib_msgs::{self, GoalID, GoalStatusArray};
use frontier_explorer::ros::msg::geometry_msgs::{Point32, PointStamped, PolygonStamped, TransformStamped};
use frontier_explorer::ros::msg::{geometry_msgs, move_base_msgs, nav_msgs, sensor_msgs, tf2_msgs};
use frontier_explorer::ros::region::{AreaDrawing, Clicked};
use frontier_explorer::ros::{Frames, GoalStatus, GoalTracker, convert};
use rosrust::RosMsg;

/// Inputs whose messages stand one after the other, each behind its length.
pub struct Cut<'a>(pub &'a [u8]);

impl<'a> Cut<'a> {
    pub fn array<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (first, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        Some(*first)
    }

    pub fn float(&mut self) -> Option<f32> {
        self.array().map(f32::from_le_bytes)
    }

    /// The next message, or what is there of it, if it can be decoded within bounds.
    pub fn message(&mut self, claims_too_much: impl Fn(&[u8]) -> bool) -> Option<&'a [u8]> {
        let length = u32::from_le_bytes(self.array()?) as usize;
        let (message, rest) = self.0.split_at(length.min(self.0.len()));
        self.0 = rest;
        (!claims_too_much(message)).then_some(message)
    }
}

/// A message behind its length.
pub fn encoded<T: RosMsg>(message: &T) -> Vec<u8> {
    message.encode_vec().unwrap()
}

/// Whether an array of numbers, so many bytes behind the header, claims more than there is: rosrust
/// would ask for its memory before it looks at what is there.
pub fn claims_too_much(bytes: &[u8], behind_header: usize) -> bool {
    let word = |at: usize| Some(u32::from_le_bytes(*bytes.get(at..)?.first_chunk()?) as usize);
    let Some(frame) = word(12) else { return false };
    let Some(length) = 16_usize.checked_add(frame).and_then(|end| word(end + behind_header)) else { return false };
    // A scan has a second array behind the first one.
    let second = word(16 + frame + behind_header + 4 + 4 * length.min(bytes.len())).unwrap_or(0);
    length.max(if behind_header == 28 { second } else { 0 }) > bytes.len()
}

fn never(_: &[u8]) -> bool {
    false
}

fn decoded<T: RosMsg>(bytes: &[u8]) -> Result<T, String> {
    T::decode(bytes).map_err(|error| error.to_string())
}

#[test]
fn transforms() {
    Target { name: "transforms", run: frames, seeds: told, memory: (16 << 20, 400), least_taken_percent: 10.0 }.fuzz();
}

/// Transforms of `/tf` in turn with those of `/tf_static`, a tenth of a second apart.
fn frames(input: &[u8]) -> Answer {
    let (mut cut, mut frames) = (Cut(input), Frames::new());
    let (mut now_s, mut last_s) = (100.0, 100.0);
    let mut said = String::new();
    let mut is_static = false;
    while let Some(message) = cut.message(never) {
        for sample in convert::transforms(decoded::<tf2_msgs::TFMessage>(message)?) {
            let newest_s = sample.stamp_s;
            if let Err(error) = frames.take(&sample, is_static, now_s) {
                said += &error.to_string();
            }
            frames.notice_time(last_s, now_s);
            last_s = now_s;
            // Time goes by the stamps where these can be.
            now_s = if (0.0..1e9).contains(&newest_s) { newest_s.max(now_s - 4.0) } else { now_s + 0.1 };
        }
        is_static = !is_static;
        let names = frames.names();
        let (first, last) = (names.first().cloned().unwrap_or_default(), names.last().cloned().unwrap_or_default());
        for (map, base) in [("map", "base_link"), (first.as_str(), last.as_str()), ("map", "laser")] {
            match frames.robot(map, base, now_s, 0.5) {
                Ok(pose) => assert!(pose.is_finite(), "{pose:?}"),
                Err(error) => said += &error.to_string().chars().take(40).collect::<String>(),
            }
            let _ = (frames.links(map, base), frames.sensor(map, base, now_s), frames.place(map, base, now_s - 0.05));
        }
    }
    Ok(said)
}

fn told() -> Vec<(String, Vec<u8>)> {
    let transform = |stamp_s: f64, parent: &str, child: &str| TransformStamped {
        header: convert::header(parent, stamp_s),
        child_frame_id: child.to_owned(),
        transform: geometry_msgs::Transform {
            translation: geometry_msgs::Vector3 { x: 0.1 * stamp_s, y: 1.0, z: 0.0 },
            rotation: convert::quaternion(0.01 * stamp_s),
        },
    };
    let tick = |stamp_s: f64| {
        let moving = vec![transform(stamp_s, "map", "odom"), transform(stamp_s, "odom", "base_link")];
        let fixed = vec![transform(stamp_s, "base_link", "laser")];
        [moving, fixed].map(|transforms| encoded(&tf2_msgs::TFMessage { transforms })).concat()
    };
    vec![("drive".to_owned(), (0..8).flat_map(|i| tick(100.0 + 0.1 * f64::from(i))).collect())]
}

#[test]
fn scans() {
    Target { name: "scans", run: scan, seeds: sweeps, memory: (8 << 20, 200), least_taken_percent: 10.0 }.fuzz();
}

fn scan(input: &[u8]) -> Answer {
    let message = Cut(input).message(|bytes| claims_too_much(bytes, 28)).ok_or("an array is too long")?;
    let message: sensor_msgs::LaserScan = decoded(message)?;
    let scan = convert::scan(&message);
    let upright = scan.clone().turned_upright();
    for sweep in [&scan, &upright] {
        let _ = sweep.sight();
        let _ = (0..sweep.ranges_m.len()).map(|beam| sweep.angle_rad(beam)).sum::<f64>();
    }
    Ok(scan.sight().map_or_else(|why| why.to_string(), |()| "seen".to_owned()))
}

fn sweeps() -> Vec<(String, Vec<u8>)> {
    vec![("sweep".to_owned(), encoded(&convert::scan_message(&sweep(), "laser", 0.1)))]
}

#[test]
fn areas() {
    Target { name: "areas", run: area, seeds: corners, memory: (16 << 20, 400), least_taken_percent: 10.0 }.fuzz();
}

/// A polygon and clicks that draw another one.
fn area(input: &[u8]) -> Answer {
    let mut cut = Cut(input);
    let message: PolygonStamped = decoded(cut.message(never).ok_or("no polygon")?)?;
    let points = message.polygon.points.iter().map(|p| Point::new(f64::from(p.x), f64::from(p.y))).collect();
    let polygon = Polygon::new(points);
    let mut said = String::new();
    match &polygon {
        Ok(polygon) => drop((polygon.contains(Point::new(1.0, 1.0)), polygon.corners().len())),
        Err(error) => said = error.to_string(),
    }
    let closed: Vec<&Polygon> = polygon.iter().collect();
    let mut drawing = AreaDrawing::default();
    while let Some(message) = cut.message(never) {
        let click: PointStamped = decoded(message)?;
        said += match drawing.click(Point::new(click.point.x, click.point.y), &closed) {
            Clicked::Corner(_) => "c",
            Clicked::TakenBack(_) => "t",
            Clicked::Closed(_) => "d",
            Clicked::Clear(_) => "l",
            Clicked::Refused(_) => "r",
        };
    }
    Ok(said)
}

fn corners() -> Vec<(String, Vec<u8>)> {
    let points = [(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0)];
    let polygon = geometry_msgs::Polygon { points: points.iter().map(|&(x, y)| Point32 { x, y, z: 0.0 }).collect() };
    let header = convert::header("map", 100.0);
    let mut bytes = encoded(&PolygonStamped { header: header.clone(), polygon });
    for (x, y) in points.iter().chain(&points[..1]) {
        let point = geometry_msgs::Point { x: 10.0 + f64::from(*x), y: f64::from(*y), z: 0.0 };
        bytes.extend(encoded(&PointStamped { header: header.clone(), point }));
    }
    vec![("drawn".to_owned(), bytes)]
}

#[test]
fn goals() {
    Target { name: "goals", run: goal, seeds: reports, memory: (8 << 20, 400), least_taken_percent: 10.0 }.fuzz();
}

/// Odometry, and a result among what an action server says of its goals.
fn goal(input: &[u8]) -> Answer {
    let mut cut = Cut(input);
    let odometry: nav_msgs::Odometry = decoded(cut.message(never).ok_or("no odometry")?)?;
    let (pose, twist) = (convert::pose(&odometry.pose.pose), convert::twist(&odometry.twist.twist));
    let result: move_base_msgs::MoveBaseActionResult = decoded(cut.message(never).ok_or("no result")?)?;
    let (mut tracker, mut now_s, mut said) = (GoalTracker::default(), 100.0, String::new());
    tracker.begin("goal-1".to_owned(), now_s);
    while let Some(message) = cut.message(never) {
        let list: GoalStatusArray = decoded(message)?;
        let one = |one: &actionlib_msgs::GoalStatus| {
            (one.goal_id.id.clone(), GoalStatus::from_number(one.status), one.text.clone())
        };
        let goals: Vec<_> = list.status_list.iter().map(one).collect();
        tracker.on_status(goals.iter().map(|(id, status, text)| (id.as_str(), *status, text.as_str())), now_s);
        said += &format!("{:?} ", tracker.state(now_s));
        now_s += 0.2;
    }
    let status = &result.status;
    tracker.on_result(&status.goal_id.id, GoalStatus::from_number(status.status), &status.text);
    said += &format!("{:?} {}", tracker.state(now_s), tracker.is_lost(now_s + 10.0));
    Ok(format!("{} {} {said}", pose.is_finite(), twist.linear_mps.is_finite()))
}

fn reports() -> Vec<(String, Vec<u8>)> {
    let status = |status: u8| actionlib_msgs::GoalStatus {
        goal_id: GoalID { stamp: convert::time(100.0), id: "goal-1".to_owned() },
        status,
        text: "on the way".to_owned(),
    };
    let lists = [0, 1, 1, 3].map(|number| {
        encoded(&GoalStatusArray { header: convert::header("", 100.0), status_list: vec![status(number), status(4)] })
    });
    let pose = convert::pose_message(&Pose::new(1.0, 2.0, 0.3));
    let odometry = nav_msgs::Odometry {
        header: convert::header("odom", 100.0),
        child_frame_id: "base_link".to_owned(),
        pose: geometry_msgs::PoseWithCovariance { pose, ..Default::default() },
        ..Default::default()
    };
    let result = move_base_msgs::MoveBaseActionResult { status: status(3), ..Default::default() };
    vec![("reached".to_owned(), [encoded(&odometry), encoded(&result), lists.concat()].concat())]
}
