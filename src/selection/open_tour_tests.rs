//! Open tours are the best or near to it, and judged as whole sums would judge them.

use super::*;
use proptest::prelude::*;

/// Distances from the origin and between places, divided by what waits there.
fn weighed(places: &[(f64, f64, f64)]) -> OpenTour {
    let first = places.iter().map(|(x, y, gain)| x.hypot(*y) / gain).collect();
    let legs = places.iter().flat_map(|a| places.iter().map(|b| (a.0 - b.0).hypot(a.1 - b.1) / b.2));
    OpenTour { first, between: legs.collect() }
}

proptest! {
    #[test]
    fn exact_orders_are_the_best_and_good_ones_are_orders(
        places in proptest::collection::vec((-9.0f64..9.0, -9.0f64..9.0, 0.1f64..3.0), 1..7),
    ) {
        let legs = weighed(&places);
        let nodes: Vec<usize> = (0..places.len()).collect();
        let best = legs.best_order();
        let least = permutations(&nodes).iter().map(|p| legs.cost(p)).fold(f64::INFINITY, f64::min);
        prop_assert!((legs.cost(&best) - least).abs() < 1e-9);
        let mut good = legs.good_order();
        prop_assert!(legs.cost(&good) >= least - 1e-9);
        // No single move makes it better.
        for from in 0..good.len() {
            for to in 0..good.len() {
                let mut moved = good.clone();
                let node = moved.remove(from);
                moved.insert(to, node);
                prop_assert!(legs.cost(&moved) >= legs.cost(&good) - 1e-6);
            }
        }
        good.sort_unstable();
        prop_assert_eq!(good, nodes);
    }

    #[test]
    fn tours_that_begin_somewhere_are_the_best_or_near_to_it(
        places in proptest::collection::vec((-9.0f64..9.0, -9.0f64..9.0, 1.0f64..1.1), 1..8),
    ) {
        let legs = weighed(&places);
        let nodes: Vec<usize> = (0..places.len()).collect();
        for begin in 0..places.len() {
            let (tour, cost) = legs.best_from(begin);
            let others = permutations(&nodes).into_iter().filter(|p| p[0] == begin);
            let least = others.map(|p| legs.cost(&p)).fold(f64::INFINITY, f64::min);
            prop_assert_eq!(tour[0], begin);
            prop_assert!((cost - least).abs() < 1e-9 && (legs.cost(&tour) - cost).abs() < 1e-9);
            let mut good = legs.bettered(legs.nearest_neighbours(Some(begin)), 1);
            prop_assert!(good[0] == begin && legs.cost(&good) <= 1.3 * least + 1e-9);
            good.sort_unstable();
            prop_assert_eq!(&good, &nodes);
        }
    }
}

proptest! {
    #[test]
    fn moves_judged_by_their_legs_are_those_of_whole_sums(
        places in proptest::collection::vec((-9.0f64..9.0, -9.0f64..9.0, 0.5f64..2.0), 1..25), kept in 0_usize..2,
    ) {
        let legs = weighed(&places);
        let begin = legs.nearest_neighbours(None);
        let (sums, cost) = (legs.sums(&begin), legs.cost(&begin));
        for step in moves(begin.len(), kept) {
            let change = legs.cost(&step.of(&begin)) - cost;
            prop_assert!((legs.change(&begin, &sums, &step) - change).abs() < 1e-9, "{:?}", step);
        }
        let mut plain = begin.clone();
        while let Some(better) = moves(begin.len(), kept)
            .map(|step| step.of(&plain))
            .find(|other| legs.cost(other) < legs.cost(&plain) - 1e-9)
        {
            plain = better;
        }
        prop_assert_eq!(legs.bettered(begin, kept), plain);
    }

    #[test]
    fn short_orders_pass_every_place_once_and_are_near_to_the_best(
        places in proptest::collection::vec((-9.0f64..9.0, -9.0f64..9.0, 1.0f64..1.1), 1..8),
    ) {
        let legs = weighed(&places);
        let nodes: Vec<usize> = (0..places.len()).collect();
        let least = legs.cost(&legs.best_order());
        for mut order in [legs.short_order(), legs.bettered(legs.nearest_neighbours(None), 0)] {
            prop_assert!(legs.cost(&order) <= 1.3 * least + 1e-9);
            order.sort_unstable();
            prop_assert_eq!(&order, &nodes);
        }
    }
}

fn permutations(nodes: &[usize]) -> Vec<Vec<usize>> {
    if nodes.is_empty() {
        return vec![Vec::new()];
    }
    let with_first = |i: usize| {
        let mut rest = nodes.to_vec();
        let first = rest.remove(i);
        permutations(&rest).into_iter().map(move |mut p| {
            p.insert(0, first);
            p
        })
    };
    (0..nodes.len()).flat_map(with_first).collect()
}
