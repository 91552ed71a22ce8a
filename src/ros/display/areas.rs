//! The region, the no-go areas, what is drawn of them so far, and what is left alone, as markers.

use super::super::convert::point_message;
use super::super::msg::geometry_msgs::{Point as PointMessage, Vector3};
use super::super::msg::std_msgs::ColorRGBA;
use super::super::msg::visualization_msgs::{Marker, MarkerArray};
use super::markers::{Shown, at, marker};
use crate::explore::{Areas, Blacklisted};
use crate::geometry::{Point, Polygon, spans_at};

/// The outline of the region.
const REGION: &str = "region";
/// The outlines of no-go areas.
const NO_GO: &str = "no_go";
/// What hatches them.
const NO_GO_FILL: &str = "no_go_fill";
/// The corners and lines of what is being drawn.
const DRAWING: &str = "drawing";
/// What failed, and the reasons.
const BLACKLIST: &str = "blacklist";
const REASONS: &str = "reasons";
/// From one line of the hatching to the next, metres; at most so many lines for an area.
const HATCH_M: f64 = 0.2;
const MOST_LINES: f64 = 500.0;

const VIOLET: ColorRGBA = ColorRGBA { r: 0.6, g: 0.2, b: 0.8, a: 1.0 };
const RED: ColorRGBA = ColorRGBA { r: 0.9, g: 0.1, b: 0.1, a: 1.0 };
const PALE_RED: ColorRGBA = ColorRGBA { a: 0.5, ..RED };
const BLACK: ColorRGBA = ColorRGBA { r: 0.05, g: 0.05, b: 0.05, a: 1.0 };

/// What is shown.
#[derive(Clone, Copy, Debug)]
pub struct ShownAreas<'a> {
    /// What is complete.
    pub areas: &'a Areas,
    /// The corners of a region so far.
    pub region_corners: &'a [Point],
    /// The corners of a no-go area so far.
    pub no_go_corners: &'a [Point],
    /// What failed in this round.
    pub blacklisted: &'a [Blacklisted],
}

/// What is shown now, to take away what is not any more.
#[derive(Clone, Debug, Default)]
pub struct AreaMarkers {
    shown: Shown,
}

impl AreaMarkers {
    /// The markers of all that is shown, and the removal of those that are no more.
    pub fn update(&mut self, input: &ShownAreas<'_>, frame: &str, stamp_s: f64) -> MarkerArray {
        let mut markers = Vec::new();
        markers.extend(input.areas.region.iter().map(|region| (REGION, outline(0, region, VIOLET))));
        for (id, area) in (0..).zip(&input.areas.no_go) {
            markers.push((NO_GO, outline(id, area, RED)));
            markers.push((NO_GO_FILL, hatching(id, area)));
        }
        let drawings = [(0, input.region_corners, VIOLET), (2, input.no_go_corners, RED)];
        for (id, corners, color) in drawings.into_iter().filter(|(_, corners, _)| !corners.is_empty()) {
            let scale = Vector3 { x: 0.25, y: 0.25, z: 0.25 };
            let points = messages(corners);
            let spheres = Marker { scale, points: points.clone(), ..marker(Marker::SPHERE_LIST, id, color.clone()) };
            markers.push((DRAWING, spheres));
            if points.len() > 1 {
                markers.push((DRAWING, line(Marker::LINE_STRIP, id + 1, points, color)));
            }
        }
        for (id, one) in (0..).zip(input.blacklisted) {
            markers.push((BLACKLIST, sphere(id, one)));
            markers.push((REASONS, reason(id, one)));
        }
        self.shown.update(markers, frame, stamp_s)
    }
}

fn messages(points: &[Point]) -> Vec<PointMessage> {
    points.iter().map(|point| point_message(point.x, point.y)).collect()
}

fn line(kind: u8, id: u64, points: Vec<PointMessage>, color: ColorRGBA) -> Marker {
    Marker { scale: Vector3 { x: 0.05, ..Vector3::default() }, points, ..marker(kind, id, color) }
}

fn outline(id: u64, area: &Polygon, color: ColorRGBA) -> Marker {
    let mut points = messages(area.corners());
    points.extend(messages(&area.corners()[..1]));
    line(Marker::LINE_STRIP, id, points, color)
}

fn hatching(id: u64, area: &Polygon) -> Marker {
    let corners: Vec<(f64, f64)> = area.corners().iter().map(|corner| (corner.x, corner.y)).collect();
    let rows = corners.iter().map(|&(_, y)| y);
    let (bottom, top) = (rows.clone().fold(f64::INFINITY, f64::min), rows.fold(f64::NEG_INFINITY, f64::max));
    let step_m = HATCH_M.max((top - bottom) / MOST_LINES);
    let lines = (0..).map(|row| bottom + (f64::from(row) + 0.5) * step_m).take_while(|&y| y < top);
    let span = |y: f64| spans_at(&corners, y).into_iter().flat_map(move |(from, to)| [(from, y), (to, y)]);
    let points = lines.flat_map(span).map(|(x, y)| point_message(x, y)).collect();
    line(Marker::LINE_LIST, id, points, PALE_RED)
}

/// As large as the circle in which other targets are left with this one.
fn sphere(id: u64, one: &Blacklisted) -> Marker {
    let scale = Vector3 { x: 2.0 * one.radius_m, y: 2.0 * one.radius_m, z: 0.1 };
    Marker { pose: at(one.target.x, one.target.y, 0.0), scale, ..marker(Marker::SPHERE, id, PALE_RED) }
}

fn reason(id: u64, one: &Blacklisted) -> Marker {
    let what = if one.is_left_alone { one.forgiven.to_string() } else { "another place is tried".to_owned() };
    let text = format!("failed {} times: {}\n{what}", one.failures, one.why);
    let (pose, scale) = (at(one.target.x, one.target.y, 0.3), Vector3 { z: 0.2, ..Vector3::default() });
    Marker { pose, scale, text, ..marker(Marker::TEXT_VIEW_FACING, id, BLACK) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::explore::Forgiven;

    fn square(x: f64) -> Polygon {
        Polygon::try_from(vec![[x, 0.0], [x + 1.0, 0.0], [x + 1.0, 1.0], [x, 1.0]]).unwrap()
    }

    #[test]
    fn areas_drawings_and_failures_are_shown_and_taken_away() {
        let areas = Areas { region: Some(square(0.0)), no_go: vec![square(3.0), square(5.0)] };
        let failed = Blacklisted {
            target: Point::new(2.0, 0.0),
            place: Point::new(1.0, 0.0),
            radius_m: 0.4,
            failures: 2,
            is_left_alone: true,
            why: "no plan".to_owned(),
            forgiven: Forgiven::AfterRound,
        };
        let (failed, corners) = ([failed], [Point::new(0.0, 0.0), Point::new(1.0, 0.0)]);
        let input = ShownAreas { areas: &areas, region_corners: &[], no_go_corners: &corners, blacklisted: &failed };
        let mut markers = AreaMarkers::default();
        let first = markers.update(&input, "map", 1.0).markers;
        let count = |ns: &str| first.iter().filter(|marker| marker.ns == ns).count();
        assert_eq!([REGION, NO_GO, NO_GO_FILL, DRAWING, BLACKLIST, REASONS].map(count), [1, 2, 2, 2, 1, 1]);
        let hatching = first.iter().find(|marker| marker.ns == NO_GO_FILL).unwrap();
        let is_inside = |point: &PointMessage| (3.0..=4.0).contains(&point.x) && (0.0..1.0).contains(&point.y);
        assert!(hatching.points.len() == 10 && hatching.points.iter().all(is_inside), "{:?}", hatching.points);
        assert!(first.iter().any(|marker| marker.text.contains("failed 2 times: no plan")));
        let none = ShownAreas { areas: &Areas::default(), no_go_corners: &[], blacklisted: &[], ..input };
        let second = markers.update(&none, "map", 2.0).markers;
        assert!(second.len() == 9 && second.iter().all(|marker| marker.action == i32::from(Marker::DELETE)));
    }
}
