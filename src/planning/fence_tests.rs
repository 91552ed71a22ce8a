//! Costmaps within areas.

use super::super::{Astar, GlobalPlanner, PathField, PlanError};
use super::*;
use crate::geometry::Polygon;
use crate::grid::{GridPatch, Inflation, OccupancyGrid, Thresholds};

/// Cells of 0.5 m; two rooms, a door between them in the middle, and a corridor above with a door
/// to each.
const ROOMS: &str = "
    ##################
    #................#
    #................#
    ###.##########.###
    #.......#........#
    #................#
    #.......#........#
    ##################";

fn map() -> OccupancyGrid {
    let drawn = OccupancyGrid::from_ascii(ROOMS).unwrap();
    let info = GridInfo::new(18, 8, 0.5, Pose::default()).unwrap();
    OccupancyGrid::new(info, drawn.data().to_vec()).unwrap()
}

fn costs(grid: &OccupancyGrid) -> Arc<Costmap> {
    let bare =
        Inflation { inscribed_radius_m: 0.0, clear_radius_m: 0.0, inflation_radius_m: 0.0, cost_scaling_factor: 1.0 };
    Arc::new(Costmap::inflate(grid, &Thresholds::default(), &bare))
}

fn area(x: (f64, f64), y: (f64, f64)) -> Polygon {
    Polygon::try_from(vec![[x.0, y.0], [x.1, y.0], [x.1, y.1], [x.0, y.1]]).unwrap()
}

/// The doors' cells are (8, 2), (3, 4) and (14, 4).
fn left() -> Areas {
    Areas { region: Some(area((0.0, 4.2), (0.0, 4.0))), no_go: Vec::new() }
}

fn plan(costmap: &Costmap, from: (f64, f64), to: (f64, f64)) -> Result<Path, PlanError> {
    Astar::default().plan(costmap, &Pose::new(from.0, from.1, 0.0), &Pose::new(to.0, to.1, 0.0))
}

#[test]
fn the_region_ends_the_ways() {
    let open = costs(&map());
    let robot = Pose::new(1.25, 1.25, 0.0);
    let closed = Fence::new(left(), 0.2).close(&open, &robot);
    let field = PathField::reach_only(Arc::clone(&closed), &robot).unwrap();
    assert!(field.reaches(Cell::new(3, 5)) && !field.reaches(Cell::new(8, 2)) && !field.reaches(Cell::new(12, 6)));
    assert!(plan(&closed, (1.25, 1.25), (7.25, 1.25)).is_err());
    assert!(Arc::ptr_eq(&Fence::new(Areas::default(), 0.2).close(&open, &robot), &open));
}

#[test]
fn a_no_go_area_in_a_door_leads_round_by_the_corridor() {
    let open = costs(&map());
    let direct = plan(&open, (1.25, 1.25), (7.25, 1.25)).unwrap();
    let areas = Areas { region: None, no_go: vec![area((4.0, 4.5), (0.5, 1.5))] };
    let mut fence = Fence::new(areas.clone(), 0.2);
    let costs = Snapshot { cells: open, changes: Changes::beginning_at(1) };
    let closed = fence.update(&costs, &Pose::new(1.25, 1.25, 0.0));
    let round = plan(&closed.cells, (1.25, 1.25), (7.25, 1.25)).unwrap();
    assert!(round.length_m() > direct.length_m() + 2.0);
    assert!(round.poses.iter().all(|pose| areas.contain(pose.position())));
    let fenced = fence.fenced().unwrap();
    assert!(fenced.keeps(&round) && !fenced.keeps(&direct));
    assert_eq!(fence.whereabouts(), Whereabouts::Inside);
}

#[test]
fn a_robot_outside_gets_in_by_the_shortest_way_and_stays() {
    let open = costs(&map());
    let robot = Pose::new(7.25, 1.25, 0.0);
    let mut fence = Fence::new(left(), 0.2);
    let closed = fence.update(&Snapshot { cells: open, changes: Changes::beginning_at(1) }, &robot);
    let Whereabouts::Leaving { no_go: false, way_m } = fence.whereabouts() else { panic!("{:?}", fence.whereabouts()) };
    assert!((3.0..4.5).contains(&way_m), "{way_m} m");
    let way = plan(&closed.cells, (7.25, 1.25), (1.25, 1.25)).unwrap();
    let fenced = fence.fenced().unwrap();
    assert!(fenced.keeps(&way), "{way:?}");
    let back = Path { poses: way.poses.iter().rev().copied().collect(), ..way.clone() };
    assert!(!fenced.keeps(&back) && !fenced.allows(Point::new(5.0, 1.25)), "no goal lies on the way in");
    assert!(plan(&closed.cells, (7.25, 1.25), (7.25, 3.25)).is_err(), "and it goes nowhere else");
}

#[test]
fn a_robot_in_a_no_go_area_leaves_it_and_no_further() {
    let open = costs(&map());
    let no_go = vec![area((1.0, 3.0), (0.5, 2.0)), area((0.0, 9.0), (2.6, 4.0))];
    let mut fence = Fence::new(Areas { region: None, no_go }, 0.1);
    let closed = fence.close(&open, &Pose::new(2.75, 1.25, 0.0));
    assert!(matches!(fence.whereabouts(), Whereabouts::Leaving { no_go: true, way_m } if way_m <= 1.5));
    assert!(plan(&closed, (2.75, 1.25), (3.75, 1.25)).is_ok());
    assert!(plan(&closed, (2.75, 1.25), (2.25, 3.25)).is_err(), "the other one stays shut");
}

#[test]
fn where_no_way_in_is_known_one_is_looked_for() {
    let mut grid = map();
    for y in 1..7 {
        for x in 9..17 {
            grid.set(Cell::new(x, y), OccupancyGrid::UNKNOWN);
        }
    }
    let right = Areas { region: Some(area((4.6, 9.0), (0.0, 4.0))), no_go: vec![area((0.0, 1.0), (0.0, 1.0))] };
    let mut fence = Fence::new(right, 0.1);
    let robot = Pose::new(2.25, 1.25, 0.0);
    let closed = fence.close(&costs(&grid), &robot);
    assert_eq!(fence.whereabouts(), Whereabouts::LockedOut { no_go: false });
    let field = PathField::reach_only(closed, &robot).unwrap();
    assert!(field.reaches(Cell::new(6, 6)) && !field.reaches(Cell::new(1, 1)));
}

/// Costs change and the robot goes in and out: as if closed anew each time.
#[test]
fn what_is_kept_closed_is_as_if_closed_anew() {
    let mut map = Live::new(Arc::new(map()));
    let mut costs_of = Live::new(costs(map.newest()));
    let areas = Areas { no_go: vec![area((2.0, 2.5), (0.5, 1.0))], ..left() };
    let mut fence = Fence::new(areas.clone(), 0.2);
    let mut last: Option<Snapshot<Costmap>> = None;
    let steps = [(1.25, 1.25, 5, 1, 100), (7.25, 1.25, 5, 1, 0), (6.25, 1.25, 12, 1, 100), (1.25, 1.25, 2, 2, 100)];
    for (x, y, column, row, value) in steps {
        map.apply(&GridPatch { corner: Cell::new(column, row), width: 1, height: 1, data: vec![value] }).unwrap();
        costs_of.replace(costs(map.newest()));
        let robot = Pose::new(x, y, 0.0);
        let closed = fence.update(&costs_of.snapshot(), &robot);
        assert_eq!(closed.cells, Fence::new(areas.clone(), 0.2).close(costs_of.newest(), &robot));
        if let Some(last) = last.replace(closed.clone()) {
            let differs = crate::grid::changed_rect(&*last.cells, &*closed.cells).unwrap_or_default();
            let told = closed.changes.since(last.changes.version());
            assert!(told.is_none_or(|told| told.union(differs) == told), "{told:?} {differs:?}");
        }
    }
}
