//! What decisions keep of the costs of a map that changes and grows: as if made anew.

use super::reach::{Passable, passable};
use super::{Driven, Fence, Opened};
use crate::geometry::{Areas, Point, Polygon, Pose};
use crate::grid::growing_tests::{growing, is_told};
use crate::grid::{Inflation, LiveCostmap, Roomy, Snapshot, Thresholds};
use proptest::prelude::*;

fn area((x, y): (f64, f64), width_m: f64, height_m: f64) -> Polygon {
    let corners = [(x, y), (x + width_m, y), (x + width_m, y + height_m), (x, y + height_m)];
    Polygon::new(corners.iter().map(|&(x, y)| Point::new(x, y)).collect()).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]
    #[test]
    fn what_is_kept_of_a_growing_map_is_as_if_made_anew(
        (mut map, steps) in growing(),
        clear_radius_m in prop_oneof![Just(0.0), 0.0f64..0.3],
        // On borders of cells, within them, and through their centres.
        corner in ((-20i32..20).prop_map(|x| f64::from(x) * 0.05), (-20i32..20).prop_map(|y| f64::from(y) * 0.05)),
        has_areas in (any::<bool>(), any::<bool>()),
        robots in proptest::collection::vec((0.0f64..1.0, 0.0f64..1.0), 7),
    ) {
        let thresholds = Thresholds::default();
        let inflation = Inflation { inscribed_radius_m: 0.1, clear_radius_m, inflation_radius_m: 0.4, cost_scaling_factor: 3.0 };
        let areas = Areas {
            region: has_areas.0.then(|| area(corner, 3.0, 4.0)),
            no_go: has_areas.1.then(|| area((corner.0 + 0.4, corner.1 + 1.0), 1.0, 0.3)).into_iter().collect(),
        };
        let (mut costs, mut roomy) = (LiveCostmap::new(thresholds, inflation), Roomy::default());
        let (mut opened, mut fence, mut kept) = (Opened::default(), Fence::new(areas.clone(), 0.1), Passable::default());
        let mut driven = Driven::default();
        let mut last: Option<[Snapshot<_>; 2]> = None;
        for (step, (x, y)) in steps.into_iter().zip(robots) {
            let info = map.newest().info();
            let at = info.from_grid_units(x * info.width() as f64, y * info.height() as f64);
            let robot = Pose::new(at.x, at.y, 0.0);
            if step.is_seen {
                for share in 0..4 {
                    driven.note(&Pose::new(at.x + 0.11 * f64::from(share), at.y, 0.0));
                }
                let costs = roomy.update(&costs.update(map.newest(), map.changes()));
                let open = opened.update(&driven, &costs, &robot);
                prop_assert_eq!(&open.cells, &driven.open(&costs.cells, &robot));
                let closed = fence.update(&open, &robot);
                let mut anew = Fence::new(areas.clone(), 0.1);
                prop_assert_eq!(&closed.cells, &anew.close(&open.cells, &robot));
                prop_assert_eq!(fence.whereabouts(), anew.whereabouts());
                prop_assert_eq!(kept.update(&closed), &passable(&closed.cells));
                if let Some([last_open, last_closed]) = last {
                    prop_assert!(is_told(&last_open, &open));
                    let may_change_all = !areas.are_everywhere() && closed.changes.since(last_closed.changes.version()).is_none();
                    prop_assert!(may_change_all || is_told(&last_closed, &closed));
                }
                last = Some([open, closed]);
            }
            step.take(&mut map);
        }
    }
}
