//! The region and the no-go areas as users set them while the node runs: polygons on topics and
//! clicks in RViz, in any frame that tf brings to the map's, and the markers that show them.

mod asked;

use super::connect::Connected;
use super::settings::{ExploreNodeError, Settings};
use crate::explore::{Areas, Blacklisted};
use crate::geometry::{Point, Polygon, PolygonError};
use crate::ros::bell::Bell;
use crate::ros::convert::seconds;
use crate::ros::display::{AreaMarkers, ShownAreas, no_markers};
use crate::ros::map_feed::MapReader;
use crate::ros::msg::geometry_msgs::{PointStamped, PolygonStamped};
use crate::ros::msg::std_msgs::Header;
use crate::ros::msg::visualization_msgs::MarkerArray;
use crate::ros::region::{AreaDrawing, Clicked};
use crate::ros::transforms::Transforms;
use crate::ros::{Feed, Node, Publisher};
use asked::wait_with;
pub use asked::{Asked, Wish};
use nalgebra::Point3;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Points and polygons come seldom: so often it is looked whether all who tell them are met.
const LOOK: Duration = Duration::from_secs(60);
/// A frame that is not known yet may be told a little later than the first map.
const FRAME_PATIENCE: Duration = Duration::from_secs(2);

/// What has been asked for so far.
struct Drawn {
    areas: Areas,
    /// Whether they were changed since they were taken.
    is_new: bool,
    region: AreaDrawing,
    no_go: AreaDrawing,
    blacklisted: Vec<Blacklisted>,
    /// What cannot be brought to the map's frame yet, and since when that was tried.
    waiting: Vec<(Asked, Option<Instant>)>,
    /// The last click: a host with two addresses gives it twice.
    last_click: Option<Asked>,
    markers: AreaMarkers,
}

struct Shared {
    node: Node,
    transforms: Arc<Transforms>,
    maps: MapReader,
    bell: Arc<Bell>,
    markers: Publisher<MarkerArray>,
    shows_markers: AtomicBool,
    drawn: Mutex<Drawn>,
}

/// The topics by which areas are set, and the areas.
pub struct AreaInputs {
    shared: Arc<Shared>,
    _feeds: [Feed; 4],
}

impl AreaInputs {
    /// Begins to listen to `~set_region`, `~add_no_go`, `clicked_point` and `~no_go_point`, with
    /// the areas of the settings, and to show all on `~areas`.
    ///
    /// # Errors
    /// [`ExploreNodeError`] when the topic cannot be offered.
    pub fn listen(node: &Node, settings: &Settings, connected: &Connected) -> Result<Self, ExploreNodeError> {
        let drawn = Drawn {
            areas: settings.preset.explorer.areas(),
            is_new: false,
            region: AreaDrawing::default(),
            no_go: AreaDrawing::default(),
            blacklisted: Vec::new(),
            waiting: Vec::new(),
            last_click: None,
            markers: AreaMarkers::default(),
        };
        let shared = Arc::new(Shared {
            node: node.clone(),
            transforms: Arc::clone(&connected.transforms),
            maps: connected.maps.clone(),
            bell: Arc::clone(&connected.bell),
            markers: node.publish_latched("~areas")?,
            shows_markers: AtomicBool::new(settings.params.visualize),
            drawn: Mutex::new(drawn),
        });
        let polygons = |topic: &str, wish: Wish| {
            let shared = Arc::clone(&shared);
            Feed::listen_seldom(node, topic, 20, LOOK, move |message: PolygonStamped, _| {
                let corner = |p: &crate::ros::msg::geometry_msgs::Point32| Point3::new(p.x, p.y, p.z).cast();
                shared.take(wish, &message.header, message.polygon.points.iter().map(corner).collect());
            })
        };
        let clicks = |topic: &str, wish: Wish| {
            let shared = Arc::clone(&shared);
            Feed::listen_seldom(node, topic, 20, LOOK, move |message: PointStamped, _| {
                let point = &message.point;
                shared.take(wish, &message.header, vec![Point3::new(point.x, point.y, point.z)]);
            })
        };
        let feeds = [
            polygons("~set_region", Wish::SetRegion),
            polygons("~add_no_go", Wish::AddNoGo),
            clicks("clicked_point", Wish::RegionClick),
            clicks("~no_go_point", Wish::NoGoClick),
        ];
        Ok(Self { shared, _feeds: feeds })
    }

    /// The areas, if they were changed since the last call.
    pub fn take_new(&self) -> Option<Areas> {
        self.shared.try_again();
        let mut drawn = self.shared.lock();
        std::mem::take(&mut drawn.is_new).then(|| drawn.areas.clone())
    }

    /// Other areas, as if they had been asked for.
    pub fn exchange(&self, areas: Areas) {
        let mut drawn = self.shared.lock();
        (drawn.areas, drawn.is_new) = (areas, true);
    }

    /// The areas as they are.
    pub fn current(&self) -> Areas {
        self.shared.lock().areas.clone()
    }

    /// Shows the areas, as in a frame that has become known.
    pub fn show(&self) {
        self.shared.show(&mut self.shared.lock());
    }

    /// Markers are shown or taken away.
    pub fn show_markers(&self, shows: bool) {
        let mut drawn = self.shared.lock();
        if self.shared.shows_markers.swap(shows, Ordering::Relaxed) && !shows {
            drawn.markers = AreaMarkers::default();
            let _ = self.shared.markers.send(no_markers());
        }
        self.shared.show(&mut drawn);
    }

    /// Shows what failed, where that is news.
    pub fn show_blacklist(&self, blacklisted: Vec<Blacklisted>) {
        let mut drawn = self.shared.lock();
        if drawn.blacklisted != blacklisted {
            drawn.blacklisted = blacklisted;
            self.shared.show(&mut drawn);
        }
    }
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, Drawn> {
        self.drawn.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The frame of the map; nothing before the first one.
    fn map_frame(&self) -> String {
        self.maps.newest().map_or_else(String::new, |map| map.frame)
    }

    fn take(&self, wish: Wish, header: &Header, points: Vec<Point3<f64>>) {
        let asked = Asked { wish, frame: header.frame_id.clone(), stamp_s: seconds(&header.stamp), points };
        let mut drawn = self.lock();
        if matches!(wish, Wish::RegionClick | Wish::NoGoClick) {
            if drawn.last_click.as_ref() == Some(&asked) {
                return;
            }
            drawn.last_click = Some(asked.clone());
        }
        wait_with(&mut drawn.waiting, asked);
        drop(drawn);
        self.try_again();
        self.bell.ring();
    }

    /// Does what waits, as far as its frames are known.
    fn try_again(&self) {
        let mut drawn = self.lock();
        if drawn.waiting.is_empty() {
            return;
        }
        let map = self.map_frame();
        for (asked, since) in std::mem::take(&mut drawn.waiting) {
            if map.is_empty() && asked.names_a_frame() {
                drawn.waiting.push((asked, None));
                continue;
            }
            match asked.to_map(&self.transforms, &map) {
                Ok(points) => self.grant(&mut drawn, asked.wish, points),
                Err(why) if since.is_some_and(|since| since.elapsed() >= FRAME_PATIENCE) => self.node.log().warn(why),
                Err(_) => drawn.waiting.push((asked, Some(since.unwrap_or_else(Instant::now)))),
            }
        }
        self.show(&mut drawn);
    }

    fn grant(&self, drawn: &mut Drawn, wish: Wish, points: Vec<Point>) {
        match wish {
            Wish::SetRegion | Wish::Order => self.close(drawn, true, Polygon::new(points.clone()), points.is_empty()),
            Wish::AddNoGo => self.close(drawn, false, Polygon::new(points.clone()), points.is_empty()),
            Wish::RegionClick | Wish::NoGoClick => {
                for point in points {
                    self.click(drawn, wish == Wish::RegionClick, point);
                }
            }
        }
    }

    /// A whole area was given, or none for an empty one.
    fn close(&self, drawn: &mut Drawn, is_region: bool, area: Result<Polygon, PolygonError>, is_empty: bool) {
        let log = self.node.log();
        match (area, is_region) {
            (_, true) if is_empty => {
                log.info("the region is cleared: everything is explored from now on");
                drawn.areas.region = None;
            }
            (_, false) if is_empty => {
                log.info(format_args!("{} no-go areas are cleared", drawn.areas.no_go.len()));
                drawn.areas.no_go.clear();
            }
            (Ok(area), true) => {
                log.info(format_args!("a region of {} corners is explored from now on", area.corners().len()));
                drawn.areas.region = Some(area);
            }
            (Ok(area), false) => {
                drawn.areas.no_go.push(area);
                let all = drawn.areas.no_go.len();
                log.info(format_args!("a no-go area is kept out of from now on: there are {all}"));
            }
            (Err(error), is_region) => {
                let wish = if is_region { Wish::SetRegion } else { Wish::AddNoGo };
                log.warn(format_args!("{}: {error}", wish.name()));
                return;
            }
        }
        drawn.is_new = true;
    }

    fn click(&self, drawn: &mut Drawn, is_region: bool, at: Point) {
        let log = self.node.log();
        let what = if is_region { "the region" } else { "a no-go area" };
        let clicked = if is_region {
            drawn.region.click(at, &drawn.areas.region.iter().collect::<Vec<_>>())
        } else {
            drawn.no_go.click(at, &drawn.areas.no_go.iter().collect::<Vec<_>>())
        };
        match clicked {
            Clicked::Corner(count) => log.info(format_args!(
                "corner {count} of {what}: a click near the first closes it, one near the last takes that back"
            )),
            Clicked::TakenBack(count) => {
                log.info(format_args!("the last corner of {what} is taken back: {count} are left"));
            }
            Clicked::Closed(area) => self.close(drawn, is_region, Ok(area), false),
            Clicked::Clear(_) if is_region => self.close(drawn, true, Err(PolygonError::NoArea), true),
            Clicked::Clear(number) => {
                drawn.areas.no_go.remove(number);
                drawn.is_new = true;
                log.info(format_args!("a no-go area is cleared: {} are left", drawn.areas.no_go.len()));
            }
            Clicked::Refused(why) => log.warn(format_args!("the clicked corners of {what}: {why}")),
        }
    }

    fn show(&self, drawn: &mut Drawn) {
        let frame = self.map_frame();
        if frame.is_empty() || !self.shows_markers.load(Ordering::Relaxed) {
            return;
        }
        let Drawn { areas, region, no_go, blacklisted, markers, .. } = drawn;
        let (region_corners, no_go_corners) = (region.corners(), no_go.corners());
        let input = ShownAreas { areas, region_corners, no_go_corners, blacklisted };
        // Nobody who listens is no error of ours.
        let _ = self.markers.send(markers.update(&input, &frame, self.node.now_s()));
    }
}
