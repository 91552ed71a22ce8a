//! All strategies on one table of candidates.

use super::*;

/// Near and small, far and large, in between behind a detour.
fn candidates() -> Vec<Candidate> {
    let at = |x: f64, size_m: f64, radius_m: f64, way_m: f64| Candidate {
        radius_m: Some(radius_m),
        nearest_m: Some(x),
        way_m: Some(way_m),
        ..Candidate::new(Point::new(x, 0.0), Pose::new(x, 0.0, 0.0), (size_m * 20.0) as usize, 0.05, &Pose::default())
    };
    vec![at(1.0, 0.3, 0.15, 9.0), at(8.0, 6.0, 3.0, 8.0), at(3.0, 2.0, 1.2, 4.0)]
}

/// Indices from best to worst.
fn order(config: SelectorConfig) -> Vec<usize> {
    let robot_in_map = Pose::default();
    let mut ways = StraightWays { robot_in_map };
    let mut context = SelectionContext::straight(&mut ways);
    let scores = config.build().score(&candidates(), &mut context);
    let mut order: Vec<usize> = (0..scores.len()).collect();
    order.sort_by(|&a, &b| scores[a].total.total_cmp(&scores[b].total));
    order
}

#[test]
fn each_strategy_has_its_own_order() {
    let by_path = SelectorConfig::Nearest(NearestConfig { distance: DistanceMeasure::Path });
    let by_size = SelectorConfig::JointCost(JointCostConfig { size_weight: 1.0, distance_weight: 0.2 });
    let explore_lite = |potential_scale| {
        SelectorConfig::ExploreLite(ExploreLiteConfig { potential_scale, ..ExploreLiteConfig::default() })
    };
    for (config, expected) in [
        (SelectorConfig::default(), [0, 2, 1]),
        (by_path, [2, 1, 0]),
        (SelectorConfig::MaxGain {}, [1, 2, 0]),
        // e = 0.15, 0.375, 0.4
        (SelectorConfig::RadiusDistance {}, [2, 1, 0]),
        (by_size, [1, 2, 0]),
        // 0.15 a metre at cells of 0.05 m, as explore_lite itself counts.
        (explore_lite(3.0), [1, 2, 0]),
        (explore_lite(60.0), [0, 2, 1]),
        // 4 / 2 + 2 / 0.3 + 7 / 6 = 9.8
        (SelectorConfig::Mrtsp {}, [2, 0, 1]),
        // 0.3 e^-0.9, 6 e^-0.8, 2 e^-0.4
        (SelectorConfig::GainDecay(GainDecayConfig::default()), [1, 2, 0]),
        (SelectorConfig::Tour(TourConfig::default()), [0, 2, 1]),
    ] {
        assert_eq!(order(config), expected, "{config:?}");
    }
}

#[test]
fn scores_are_finite_name_their_parts_and_come_one_for_each() {
    let robot_in_map = Pose::default();
    let mut ways = StraightWays { robot_in_map };
    let mut context = SelectionContext::straight(&mut ways);
    for config in SelectorConfig::all() {
        let mut selector = config.build();
        assert!(selector.score(&[], &mut context).is_empty());
        let scores = selector.score(&candidates(), &mut context);
        assert_eq!(scores.len(), 3);
        assert!(scores.iter().all(|s| s.total.is_finite() && !s.parts.is_empty()), "{}", selector.name());
        let yaml = serde_json::to_value(config).unwrap();
        assert_eq!(yaml["name"], selector.name());
    }
}

#[test]
fn unknown_parameters_are_refused() {
    for text in [r#"{"name": "max_gain", "x": 1}"#, r#"{"name": "nearest", "x": 1}"#, r#"{"name": "farthest"}"#] {
        assert!(serde_json::from_str::<SelectorConfig>(text).is_err(), "{text}");
    }
    let negative = SelectorConfig::JointCost(JointCostConfig { size_weight: -1.0, distance_weight: 1.0 });
    assert_eq!(negative.validate().unwrap_err().to_string(), "selection.size_weight is -1: must be finite and >= 0");
}

#[test]
fn a_tour_goes_on_to_a_target_that_is_far_away() {
    // Eight places near by, and far away the one that the robot is on its way to.
    let robot_in_map = Pose::default();
    let at = |x: f64, y: f64| Candidate::new(Point::new(x, y), Pose::new(x, y, 0.0), 10, 0.5, &robot_in_map);
    let mut candidates: Vec<Candidate> = (0..8).map(|i| at(30.0, f64::from(i))).collect();
    candidates.push(at(-31.0, 0.0));
    let mut ways = StraightWays { robot_in_map };
    let mut first = |under_way: Option<Point>| {
        let tour = TourConfig { most: 8, turn_m_per_rad: 0.0, stay_m: 200.0, ..TourConfig::default() };
        let mut context = SelectionContext { under_way, ..SelectionContext::straight(&mut ways) };
        let scores = Tour(tour).score(&candidates, &mut context);
        scores.iter().position(|score| score.total == 0.0)
    };
    assert!(first(None).is_some_and(|first| first < 8));
    assert_eq!(first(Some(Point::new(-30.0, 0.0))), Some(8));
    assert!(first(Some(Point::new(0.0, 30.0))).is_some_and(|first| first < 8), "it is gone");
}
