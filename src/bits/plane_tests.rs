//! Runs and bits at the seams of words.

use super::*;

#[test]
fn runs_are_cleared_to_the_cell() {
    for (start, end) in [(0, 0), (0, 1), (3, 3), (60, 64), (64, 65), (63, 129), (0, 200), (199, 200), (128, 192)] {
        let mut plane = BitPlane::new(200, 3);
        for x in 0..200 {
            plane.insert(Cell::new(x, 1));
        }
        plane.clear_run(1, start, end);
        for x in 0..200 {
            let inside = (start..end).contains(&(x as usize));
            assert_eq!(plane.contains(Cell::new(x, 1)), !inside, "{start}..{end} at {x}");
        }
        assert_eq!(plane.count(), 200 - (end - start));
    }
}

#[test]
fn outside_nothing_is_set() {
    let mut plane = BitPlane::new(65, 2);
    for cell in [Cell::new(-1, 0), Cell::new(65, 0), Cell::new(0, 2), Cell::new(0, -1)] {
        plane.insert(cell);
        assert!(!plane.contains(cell) && !plane.remove(cell));
    }
    assert_eq!(plane.count(), 0);
    plane.insert(Cell::new(64, 1));
    assert!(plane.remove(Cell::new(64, 1)) && !plane.remove(Cell::new(64, 1)));
    assert_eq!((plane.row_words(), plane.last_word_mask()), (2, 1));
    assert_eq!(BitPlane::new(128, 1).last_word_mask(), u64::MAX);
}
