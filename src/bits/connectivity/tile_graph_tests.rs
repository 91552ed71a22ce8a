//! What is reached through tiles against a labelling of the whole plane.

use super::*;
use crate::bits::labels::Labels;
use crate::bits::window::Window;
use crate::bits::word_spans::WordSpan;
use proptest::prelude::*;

const WIDTH: usize = 600;
const HEIGHT: usize = 200;

/// A line from a cell on, in one of eight directions: diagonals hold together at corners
/// alone, and cross the seams of tiles there.
fn line() -> impl Strategy<Value = Vec<Cell>> {
    let near = |seams: [i32; 3]| {
        let seam = prop_oneof![Just(seams[0]), Just(seams[1]), Just(seams[2])];
        (seam, -6i32..6).prop_map(|(seam, off)| seam + off)
    };
    let start = (near([100, 256, 512]), near([30, 64, 128]));
    (start, 0usize..8, 1i32..90).prop_map(|((x, y), direction, length)| {
        let (dx, dy) = Neighbourhood::Eight.offsets()[direction];
        (0..length).map(|i| Cell::new(x + i * dx, y + i * dy)).collect()
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    #[test]
    fn tiles_reach_what_is_connected(
        steps in proptest::collection::vec((proptest::collection::vec((line(), any::<bool>()), 1..12), any::<prop::sample::Index>()), 1..6),
        eight: bool,
    ) {
        let neighbourhood = if eight { Neighbourhood::Eight } else { Neighbourhood::Four };
        let mut plane = BitPlane::new(WIDTH, HEIGHT);
        let mut reach = TileGraph::new(neighbourhood);
        reach.reset(WIDTH, HEIGHT);
        for (lines, seed) in steps {
            let cells: Vec<Cell> = lines.iter().flat_map(|(cells, _)| cells.clone()).collect();
            for (cells, is_set) in &lines {
                for &cell in cells.iter().filter(|c| (0..WIDTH as i32).contains(&c.x) && (0..HEIGHT as i32).contains(&c.y)) {
                    if *is_set { plane.insert(cell) } else { plane.remove(cell); }
                    reach.mark_dirty(cell.y as usize, cell.x as usize / 64);
                }
            }
            let before = reach.plane().clone();
            let seed = cells[seed.index(cells.len())];
            reach.update(&plane, &[seed]);
            let all = Window::of(&plane);
            let mut labels = Labels::default();
            labels.label(&plane, &all, neighbourhood);
            let kept = labels.component_at(&plane, &all, seed);
            let mut expected = BitPlane::new(WIDTH, HEIGHT);
            labels.select(&plane, &all, |c| Some(c) == kept, |y, i, word| expected.row_mut(y)[i] = word);
            prop_assert!(reach.plane() == &expected, "{} of {} cells", reach.plane().count(), expected.count());
            for y in 0..HEIGHT {
                let words = (0..plane.row_words()).filter(|&i| before.row(y)[i] != expected.row(y)[i]);
                let mut differ = WordSpan::NONE;
                words.for_each(|i| differ.join(WordSpan::of(&(i..i + 1))));
                let told: Vec<_> = reach.changed().iter().filter(|&(row, _)| row == y).map(|(_, span)| span).collect();
                prop_assert_eq!(told, if differ.is_empty() { vec![] } else { vec![differ] });
            }
        }
    }
}
