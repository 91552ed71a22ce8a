//! The fill by rows against labels of runs.

use super::*;
use crate::bits::labels::Labels;
use crate::bits::window::Window;
use proptest::prelude::*;

/// The cells connected to a seed, by their labels.
fn labelled(open: &BitPlane, neighbourhood: Neighbourhood, seed: Cell) -> BitPlane {
    let mut labels = Labels::default();
    let all = Window::of(open);
    labels.label(open, &all, neighbourhood);
    let kept = labels.component_at(open, &all, seed);
    let mut reached = BitPlane::new(open.width(), open.height());
    labels.select(open, &all, |c| Some(c) == kept, |y, i, word| reached.row_mut(y)[i] = word);
    reached
}

/// Cells set at random, from few to nearly all.
fn noise() -> impl Strategy<Value = (BitPlane, usize)> {
    (1usize..=200, 1usize..=30, 0.1f64..0.99)
        .prop_flat_map(|(w, h, share)| {
            let values = proptest::collection::vec(proptest::bool::weighted(share), w * h);
            (Just(w), values, 0..w * h)
        })
        .prop_map(|(width, values, seed)| (BitPlane::of_values(width, &values, |value| value), seed))
}

/// A way back and forth over rows of a width: each row of walls has one gap, in turn at
/// its end and at its beginning.
fn serpentine(width: usize, height: usize) -> BitPlane {
    let values: Vec<bool> = (0..width * height)
        .map(|i| (i / width, i % width))
        .map(|(y, x)| y % 2 == 0 || x == if y % 4 == 1 { width - 1 } else { 0 })
        .collect();
    BitPlane::of_values(width, &values, |value| value)
}

/// A way around and around that ends in the middle.
fn spiral(edge: usize) -> BitPlane {
    let mut plane = BitPlane::new(edge, edge);
    let (mut x, mut y, mut turn) = (0i32, 0i32, 0);
    let mut length = edge as i32 - 1;
    plane.insert(Cell::new(0, 0));
    while length > 0 {
        for _ in 0..length {
            let (dx, dy) = [(1, 0), (0, 1), (-1, 0), (0, -1)][turn % 4];
            (x, y) = (x + dx, y + dy);
            plane.insert(Cell::new(x, y));
        }
        turn += 1;
        if turn > 2 && turn % 2 == 1 {
            length -= 2;
        }
    }
    plane
}

proptest! {
    #[test]
    fn what_is_filled_is_the_component_of_the_seed((open, seed) in noise()) {
        let seed = Cell::new((seed % open.width()) as i32, (seed / open.width()) as i32);
        // A fill that was cut off or of another size leaves nothing behind.
        let mut flood = RowFill::default();
        let mut reached = BitPlane::default();
        for neighbourhood in [Neighbourhood::Four, Neighbourhood::Eight] {
            let expected = labelled(&open, neighbourhood, seed);
            for most_steps in [1, 3, usize::MAX] {
                let done = flood.fill_within(&open, neighbourhood, seed, &mut reached, most_steps);
                prop_assert!(done.is_some() || most_steps < usize::MAX);
                prop_assert!(done.is_none() || reached == expected, "{:?} {:?}", neighbourhood, seed);
            }
        }
    }
}

#[test]
fn ways_that_wind_are_followed_to_their_end() {
    for size in 1..140 {
        for open in [serpentine(size, 9), spiral(size)] {
            for neighbourhood in [Neighbourhood::Four, Neighbourhood::Eight] {
                let mut reached = BitPlane::default();
                let seed = Cell::new(0, 0);
                let done = RowFill::default().fill_within(&open, neighbourhood, seed, &mut reached, usize::MAX);
                assert_eq!(done, Some(()));
                assert_eq!(reached, labelled(&open, neighbourhood, seed), "{size} {neighbourhood:?}");
            }
        }
    }
}

#[test]
fn a_spiral_is_given_up() {
    let open = spiral(400);
    assert_eq!(RowFill::default().fill(&open, Neighbourhood::Four, Cell::new(0, 0), &mut BitPlane::default()), None);
}

#[test]
fn nothing_is_connected_to_what_is_not_open() {
    let open = BitPlane::new(70, 3);
    let mut reached = BitPlane::new(70, 3);
    reached.insert(Cell::new(1, 1));
    for seed in [Cell::new(1, 1), Cell::new(-1, 0), Cell::new(70, 0)] {
        assert_eq!(RowFill::default().fill(&open, Neighbourhood::Eight, seed, &mut reached), Some(()));
        assert_eq!(reached.count(), 0);
    }
}
