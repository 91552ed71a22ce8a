//! What is listened to, and what has come of it.

use super::facts::{MapSeen, Wanted};
use crate::grid::{OccupancyGrid, Thresholds};
use crate::ros::convert;
use crate::ros::directory::Listing;
use crate::ros::feed::Feed;
use crate::ros::msg::actionlib_msgs::{GoalStatus, GoalStatusArray};
use crate::ros::msg::nav_msgs::OccupancyGrid as MapMessage;
use crate::ros::msg::sensor_msgs::LaserScan as ScanMessage;
use crate::ros::node::Node;
use crate::ros::transforms::Transforms;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Nothing is listened to for so long that a subscription would have to be made anew.
const SILENCE: Duration = Duration::from_secs(600);

/// What has come of a map topic.
#[derive(Default)]
pub struct HeardMap {
    /// The newest map with the frame that it is in.
    pub newest: Option<(OccupancyGrid, String)>,
    /// Why the last message was no map.
    pub broken: Option<String>,
    /// When the first and the last message came, and how many there were.
    pub arrivals: Option<(Instant, Instant, u32)>,
}

impl HeardMap {
    /// Seconds from one message to the next, where more than one came.
    #[must_use]
    pub fn period_s(&self) -> Option<f64> {
        let (first, last, count) = self.arrivals.filter(|(.., count)| *count > 1)?;
        Some(last.duration_since(first).as_secs_f64() / f64::from(count - 1))
    }

    /// The newest map in numbers.
    #[must_use]
    pub fn seen(&self) -> Option<MapSeen> {
        let (grid, _) = self.newest.as_ref()?;
        let (info, census) = (grid.info(), grid.census(&Thresholds::default()));
        Some(MapSeen {
            width: info.width(),
            height: info.height(),
            resolution_m: info.resolution_m(),
            free: census.free,
            unknown: census.unknown,
        })
    }
}

/// What the server told of its goals.
#[derive(Default)]
pub struct HeardStatus {
    /// Whether any status came.
    pub has_come: bool,
    /// The ids of goals under way.
    pub under_way: Vec<String>,
}

/// All that is listened to, until this is dropped.
pub struct Ears {
    pub map: Arc<Mutex<HeardMap>>,
    pub costmap: Arc<Mutex<HeardMap>>,
    pub status: Arc<Mutex<HeardStatus>>,
    /// What is wrong with the last scan; none when none came.
    pub scan: Arc<Mutex<Option<Result<(), String>>>>,
    pub transforms: Transforms,
    _feeds: Vec<Feed>,
}

impl Ears {
    /// Begins to listen to what is wanted, but for topics of another type.
    #[must_use]
    pub fn open(node: &Node, wanted: &Wanted, listing: &Listing) -> Self {
        let (map, costmap) = (Arc::<Mutex<HeardMap>>::default(), Arc::<Mutex<HeardMap>>::default());
        let (status, scan) =
            (Arc::<Mutex<HeardStatus>>::default(), Arc::<Mutex<Option<Result<(), String>>>>::default());
        let is_of = |topic: &str, kind: &str| listing.type_of(topic).is_none_or(|other| other == kind);
        let mut feeds = Vec::new();
        if is_of(&wanted.map_topic, "nav_msgs/OccupancyGrid") {
            feeds.push(listen_to_map(node, &wanted.map_topic, &map));
        }
        if let Some(server) = &wanted.move_base {
            feeds.push(listen_to_map(node, &costmap_topic(server), &costmap));
            feeds.push(listen_to_status(node, &format!("{server}/status"), &status));
        }
        if let Some(topic) = wanted.scan_topic.as_ref().filter(|topic| is_of(topic, "sensor_msgs/LaserScan")) {
            let theirs = Arc::clone(&scan);
            feeds.push(Feed::listen(node, topic, 2, SILENCE, move |message: ScanMessage, _| {
                let sight = convert::scan(&message).sight().map_err(|why| why.to_string());
                // A sight that came once is enough: single scans may be blind.
                let mut last = lock(&theirs);
                if !matches!(*last, Some(Ok(()))) {
                    *last = Some(sight);
                }
            }));
        }
        Self { map, costmap, status, scan, transforms: Transforms::listen(node), _feeds: feeds }
    }

    /// The frame of the map; `map` until one has come.
    #[must_use]
    pub fn map_frame(&self) -> String {
        lock(&self.map).newest.as_ref().map_or_else(|| "map".to_owned(), |(_, frame)| frame.clone())
    }

    /// Whether everything has come that somebody publishes, but for transforms.
    #[must_use]
    pub fn have_heard(&self, wanted: &Wanted, listing: &Listing) -> bool {
        let is_silent = |topic: &str| listing.publishers(topic).is_empty();
        let has_map = |topic: &str, heard: &Mutex<HeardMap>| is_silent(topic) || lock(heard).arrivals.is_some();
        let server = wanted.move_base.as_ref().is_none_or(|server| {
            let has_status = lock(&self.status).has_come || is_silent(&format!("{server}/status"));
            has_status && has_map(&costmap_topic(server), &self.costmap)
        });
        let scans = wanted.scan_topic.as_ref().is_none_or(|topic| is_silent(topic) || lock(&self.scan).is_some());
        server && scans && has_map(&wanted.map_topic, &self.map)
    }
}

/// The topic of a server's global costmap.
#[must_use]
pub fn costmap_topic(server: &str) -> String {
    format!("{server}/global_costmap/costmap")
}

/// What a mutex holds, also after a panic of another.
pub fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

fn listen_to_map(node: &Node, topic: &str, heard: &Arc<Mutex<HeardMap>>) -> Feed {
    let theirs = Arc::clone(heard);
    Feed::listen(node, topic, 2, SILENCE, move |message: MapMessage, _| {
        let (now, frame) = (Instant::now(), message.header.frame_id.clone());
        let grid = convert::grid(message);
        let mut heard = lock(&theirs);
        let (first, _, count) = heard.arrivals.unwrap_or((now, now, 0));
        heard.arrivals = Some((first, now, count + 1));
        match grid {
            Ok(grid) => heard.newest = Some((grid, frame)),
            Err(why) => heard.broken = Some(why.to_string()),
        }
    })
}

fn listen_to_status(node: &Node, topic: &str, heard: &Arc<Mutex<HeardStatus>>) -> Feed {
    const UNDER_WAY: [u8; 4] = [GoalStatus::PENDING, GoalStatus::ACTIVE, GoalStatus::PREEMPTING, GoalStatus::RECALLING];
    let theirs = Arc::clone(heard);
    Feed::listen(node, topic, 10, SILENCE, move |message: GoalStatusArray, _| {
        let goals = message.status_list.into_iter().filter(|goal| UNDER_WAY.contains(&goal.status));
        let under_way = goals.map(|goal| goal.goal_id.id).collect();
        *lock(&theirs) = HeardStatus { has_come: true, under_way };
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_period_is_that_between_arrivals() {
        let began = Instant::now();
        let after =
            |count| HeardMap { arrivals: Some((began, began + Duration::from_secs(6), count)), ..HeardMap::default() };
        assert_eq!((after(4).period_s(), after(1).period_s(), HeardMap::default().period_s()), (Some(2.0), None, None));
    }

    #[test]
    fn a_map_is_told_in_numbers() {
        let newest = OccupancyGrid::from_ascii("?#\n..").map(|grid| (grid, "map".to_owned()));
        let seen = HeardMap { newest, ..HeardMap::default() }.seen().unwrap();
        assert_eq!((seen.width, seen.height, seen.free, seen.unknown), (2, 2, 2, 1));
    }
}
