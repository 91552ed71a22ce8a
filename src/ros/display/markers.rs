//! Frontiers as markers: their cells, the points that stand for them, and the order in
//! which they come. A frontier keeps its marker while it overlaps with what it was, so
//! that nothing flickers; the namespace is explore_lite's.

use super::super::convert::{header, point_message};
use super::super::msg::geometry_msgs::{Point as PointMessage, Pose as PoseMessage, Quaternion, Vector3};
use super::super::msg::std_msgs::ColorRGBA;
use super::super::msg::visualization_msgs::{Marker, MarkerArray};
use crate::explore::{CandidateRecord, CandidateStatus, DecisionRecord, SeenFrontiers};
use crate::geometry::Pose;
use crate::selection::PLACE;
use std::collections::BTreeSet;

/// The cells of a frontier.
const CELLS: &str = "frontiers";
/// The point that stands for it.
const TARGETS: &str = "targets";
/// Its place in the order.
const ORDER: &str = "order";
/// The tour past the frontiers, where the strategy plans one.
const TOUR: &str = "tour";
/// So many places are written out.
const NUMBERED: usize = 20;

/// What is shown now, to take away what is not any more.
#[derive(Clone, Debug, Default)]
pub struct FrontierMarkers {
    shown: Shown,
}

impl FrontierMarkers {
    /// The markers of a decision, and the removal of those that it does not have.
    pub fn update(
        &mut self,
        record: &DecisionRecord,
        frontiers: &SeenFrontiers,
        resolution_m: f64,
        frame: &str,
        stamp_s: f64,
    ) -> MarkerArray {
        let mut markers = Vec::new();
        let mut rank = 0;
        for candidate in &record.candidates {
            let color = color(candidate.status);
            let cells: Vec<PointMessage> =
                frontiers.cells_of(candidate.id).map(|cell| point_message(cell.x, cell.y)).collect();
            if !cells.is_empty() {
                markers.push(cubes(candidate.id, cells, resolution_m, color.clone()));
            }
            markers.push(sphere(candidate, color));
            if matches!(candidate.status, CandidateStatus::Chosen | CandidateStatus::Eligible) {
                rank += 1;
                if rank <= NUMBERED {
                    markers.push(number(candidate, rank));
                }
            }
        }
        markers.extend(tour(record));
        self.shown.update(markers, frame, stamp_s)
    }
}

/// The markers that are shown now, by their namespaces and numbers.
#[derive(Clone, Debug, Default)]
pub(super) struct Shown(BTreeSet<(&'static str, i32)>);

impl Shown {
    /// Markers in a frame, with the removal of those that were shown and are not among them.
    pub fn update(&mut self, markers: Vec<(&'static str, Marker)>, frame: &str, stamp_s: f64) -> MarkerArray {
        let now: BTreeSet<(&'static str, i32)> = markers.iter().map(|(ns, marker)| (*ns, marker.id)).collect();
        let gone = self
            .0
            .difference(&now)
            .map(|&(ns, id)| (ns, Marker { id, action: i32::from(Marker::DELETE), ..Marker::default() }));
        let all: Vec<(&'static str, Marker)> = gone.collect::<Vec<_>>().into_iter().chain(markers).collect();
        self.0 = now;
        let finish = |(ns, mut marker): (&'static str, Marker)| {
            marker.header = header(frame, stamp_s);
            marker.ns = ns.to_owned();
            marker
        };
        MarkerArray { markers: all.into_iter().map(finish).collect() }
    }
}

/// Takes all markers of a topic away.
#[must_use]
pub fn no_markers() -> MarkerArray {
    MarkerArray { markers: vec![Marker { action: i32::from(Marker::DELETEALL), ..Marker::default() }] }
}

/// Chosen green, possible blue, left alone red, out of reach grey, elsewhere violet.
const fn color(status: CandidateStatus) -> ColorRGBA {
    let (r, g, b) = match status {
        CandidateStatus::Chosen | CandidateStatus::AlreadyThere => (0.1, 0.8, 0.2),
        CandidateStatus::Eligible => (0.1, 0.4, 1.0),
        CandidateStatus::Taboo => (0.9, 0.1, 0.1),
        CandidateStatus::NoPath | CandidateStatus::Unreachable | CandidateStatus::TooNarrow => (0.5, 0.5, 0.5),
        CandidateStatus::OutsideRegion => (0.6, 0.3, 0.8),
    };
    ColorRGBA { r, g, b, a: 1.0 }
}

/// A marker's id from a frontier's: 32 bits serve four billion frontiers.
const fn marker_id(id: u64) -> i32 {
    (id & 0x7fff_ffff) as i32
}

pub(super) fn marker(kind: u8, id: u64, color: ColorRGBA) -> Marker {
    Marker {
        id: marker_id(id),
        type_: i32::from(kind),
        action: i32::from(Marker::ADD),
        pose: at(0.0, 0.0, 0.0),
        color,
        ..Marker::default()
    }
}

fn cubes(id: u64, points: Vec<PointMessage>, resolution_m: f64, color: ColorRGBA) -> (&'static str, Marker) {
    let scale = Vector3 { x: resolution_m, y: resolution_m, z: 0.02 };
    (CELLS, Marker { scale, points, ..marker(Marker::CUBE_LIST, id, color) })
}

fn sphere(candidate: &CandidateRecord, color: ColorRGBA) -> (&'static str, Marker) {
    let size = if candidate.status == CandidateStatus::Chosen { 0.3 } else { 0.15 };
    let pose = at(candidate.target.x, candidate.target.y, 0.05);
    let scale = Vector3 { x: size, y: size, z: size };
    (TARGETS, Marker { pose, scale, ..marker(Marker::SPHERE, candidate.id, color) })
}

fn number(candidate: &CandidateRecord, rank: usize) -> (&'static str, Marker) {
    let pose = at(candidate.target.x, candidate.target.y, 0.35);
    let black = ColorRGBA { r: 0.05, g: 0.05, b: 0.05, a: 1.0 };
    let scale = Vector3 { z: 0.35, ..Vector3::default() };
    let text = rank.to_string();
    (ORDER, Marker { pose, scale, text, ..marker(Marker::TEXT_VIEW_FACING, candidate.id, black) })
}

/// A line from the robot past the places of a tour in their order, if there is one.
fn tour(record: &DecisionRecord) -> Option<(&'static str, Marker)> {
    let place = |c: &CandidateRecord| Some((*c.scores.get(PLACE)?, c.goal?));
    let mut places: Vec<(f64, Pose)> = record.candidates.iter().filter_map(place).collect();
    places.sort_by(|a, b| a.0.total_cmp(&b.0));
    if places.is_empty() {
        return None;
    }
    let poses = [record.pose].into_iter().chain(places.into_iter().take(NUMBERED).map(|(_, goal)| goal));
    let points = poses.map(|pose| point_message(pose.x, pose.y)).collect();
    let orange = ColorRGBA { r: 1.0, g: 0.55, b: 0.0, a: 0.8 };
    let scale = Vector3 { x: 0.05, ..Vector3::default() };
    Some((TOUR, Marker { scale, points, ..marker(Marker::LINE_STRIP, 0, orange) }))
}

pub(super) const fn at(x: f64, y: f64, z: f64) -> PoseMessage {
    PoseMessage { position: PointMessage { x, y, z }, orientation: Quaternion { x: 0.0, y: 0.0, z: 0.0, w: 1.0 } }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::explore::Position;
    use crate::frontier::{CellSide, Frontier};
    use crate::grid::{Cell, GridInfo};

    fn candidate(id: u64, status: CandidateStatus) -> CandidateRecord {
        CandidateRecord {
            id,
            target: Position { x: id as f64, y: 0.0 },
            goal: None,
            size_cells: 1,
            size_m: 0.05,
            distance_m: 1.0,
            path_m: None,
            scores: std::collections::BTreeMap::new(),
            status,
        }
    }

    fn show(markers: &mut FrontierMarkers, candidates: Vec<CandidateRecord>) -> Vec<(String, i32, i32)> {
        let info = GridInfo::new(20, 1, 1.0, Pose::default()).unwrap();
        let frontier = |c: &CandidateRecord| Frontier {
            id: c.id,
            cells: vec![Cell::new(c.id as i32, 0)].into(),
            side: CellSide::Unknown,
            circle: None,
        };
        let frontiers = SeenFrontiers::new(info, candidates.iter().map(frontier).collect());
        let record = DecisionRecord { time_s: 1.0, pose: Pose::default(), candidates, goal: None, why: String::new() };
        let array = markers.update(&record, &frontiers, 0.05, "map", 1.0);
        assert!(array.markers.iter().all(|m| m.header.frame_id == "map"));
        array.markers.iter().map(|m| (m.ns.clone(), m.id, m.action)).collect()
    }

    #[test]
    fn what_is_gone_is_deleted_and_what_stays_keeps_its_id() {
        let mut markers = FrontierMarkers::default();
        let both = vec![candidate(7, CandidateStatus::Chosen), candidate(9, CandidateStatus::Taboo)];
        let first = show(&mut markers, both);
        let expected = [("frontiers", 7), ("targets", 7), ("order", 7), ("frontiers", 9), ("targets", 9)];
        assert_eq!(first, expected.map(|(ns, id)| (ns.to_owned(), id, 0)));
        let second = show(&mut markers, vec![candidate(9, CandidateStatus::Eligible)]);
        let gone: Vec<_> =
            second.iter().filter(|m| m.2 == i32::from(Marker::DELETE)).map(|m| (m.0.as_str(), m.1)).collect();
        assert_eq!(gone, [("frontiers", 7), ("order", 7), ("targets", 7)]);
        assert!(second.contains(&("order".to_owned(), 9, 0)));
        let third = show(&mut markers, Vec::new());
        assert!(third.len() == 3 && third.iter().all(|m| m.2 == i32::from(Marker::DELETE)));
        assert!(show(&mut markers, Vec::new()).is_empty());
    }

    #[test]
    fn a_tour_is_a_line_from_the_robot_in_its_order() {
        let on_tour = |id: u64, place: f64| {
            let goal = Some(Pose::new(id as f64, 1.0, 0.0));
            let scores = std::collections::BTreeMap::from([(PLACE, place)]);
            CandidateRecord { goal, scores, ..candidate(id, CandidateStatus::Eligible) }
        };
        let candidates = vec![on_tour(5, 1.0), on_tour(8, 0.0), candidate(3, CandidateStatus::Taboo)];
        let pose = Pose::new(2.0, 2.0, 0.0);
        let mut record = DecisionRecord { time_s: 1.0, pose, candidates, goal: None, why: String::new() };
        let (_, line) = tour(&record).unwrap();
        let at: Vec<(f64, f64)> = line.points.iter().map(|p| (p.x, p.y)).collect();
        assert_eq!(at, [(2.0, 2.0), (8.0, 1.0), (5.0, 1.0)]);
        record.candidates.truncate(0);
        assert!(tour(&record).is_none());
    }
}
