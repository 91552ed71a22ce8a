//! The robot's outline: move_base's against its inflation, and against ours.

use super::super::costmap_params::CostmapParams;
use super::super::facts::{OwnOutline, ServerFacts};
use super::super::finding::Finding;

const CHECK: &str = "footprint";
/// Outlines that differ by less are the same, metres.
const ALIKE_M: f64 = 0.05;

/// What is to be said of the outlines, as far as move_base's parameters tell.
pub fn judge(own: &OwnOutline, server: &ServerFacts, params: &CostmapParams) -> Finding {
    let OwnOutline { robot, inscribed_m, circumscribed_m } = own;
    let theirs =
        params.footprint.as_ref().map(|outline| (outline.inscribed_radius_m(), outline.circumscribed_radius_m()));
    let name = server.name.trim_start_matches('/');
    if let Some(inflation_m) = params.inflation_radius_m {
        let widest = theirs.map_or(*inscribed_m, |(theirs_m, _)| theirs_m.max(*inscribed_m));
        if widest > inflation_m {
            let what = format!(
                "the robot's inscribed radius is {widest:.2} m, and {name} inflates obstacles by {inflation_m:.2} m \
                 only: it plans ways on which the robot does not fit"
            );
            let remedy = format!(
                "set `global_costmap/inflation_layer/inflation_radius` of {name}, and the local one, to more than \
                 {circumscribed_m:.2}"
            );
            return Finding::warning(CHECK, what, remedy);
        }
    }
    let Some((theirs_inscribed_m, theirs_circumscribed_m)) = theirs else {
        return Finding::ok(CHECK, format!("the parameters of {name} tell no outline; ours is that of {robot}"));
    };
    let differs = (theirs_inscribed_m - inscribed_m).abs() > ALIKE_M
        || (theirs_circumscribed_m - circumscribed_m).abs() > ALIKE_M;
    let (ours, theirs) = (
        format!("{inscribed_m:.2} to {circumscribed_m:.2} m"),
        format!("{theirs_inscribed_m:.2} to {theirs_circumscribed_m:.2} m"),
    );
    if differs {
        let what = format!("the outline of {name} is {theirs} around its centre, and that of our robot {robot} {ours}");
        let remedy = "set ~robot to the robot that drives: a built-in one, or a YAML file as in configs/robots";
        return Finding::warning(CHECK, what, remedy);
    }
    Finding::ok(CHECK, format!("the outline of {name}, {theirs}, is that of {robot}"))
}

#[cfg(test)]
mod tests {
    use super::super::super::finding::FindingLevel::{Ok, Warning};
    use super::super::testing::{server, wanted};
    use super::*;
    use crate::geometry::Footprint;

    fn check(radius_m: Option<f64>, inflation_radius_m: Option<f64>) -> Finding {
        let footprint = radius_m.map(Footprint::RadiusM);
        let params = CostmapParams { footprint, inflation_radius_m, ..CostmapParams::default() };
        judge(&wanted().outline, &server(), &params)
    }

    #[test]
    fn outlines_that_agree_and_are_inflated_are_well() {
        assert_eq!(check(Some(0.2), Some(0.5)).level, Ok);
        assert_eq!(check(None, None).level, Ok);
        assert_eq!(check(Some(0.2), None).level, Ok);
    }

    #[test]
    fn too_little_inflation_is_named_for_either_outline() {
        for radius in [None, Some(0.2)] {
            let finding = check(radius, Some(0.1));
            assert!(finding.level == Warning && finding.what.contains("by 0.10 m only"), "{finding:?}");
        }
        assert!(check(Some(0.4), Some(0.3)).what.contains("inscribed radius is 0.40 m"));
    }

    #[test]
    fn outlines_that_differ_are_named() {
        let finding = check(Some(0.46), Some(0.6));
        assert_eq!(finding.level, Warning);
        let what = "the outline of move_base is 0.46 to 0.46 m around its centre, and that of our robot turtlebot2 \
                    0.18 to 0.18 m";
        assert_eq!(finding.what, what);
    }
}
