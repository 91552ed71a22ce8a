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
fn cells_of_a_plane_that_grows_stay_beside_each_other() {
    let mut plane = BitPlane::new(70, 5);
    let cells = || (0..350).filter(|i| i % 7 < 3 || i % 5 == 1).map(|i| Cell::new(i % 70, i / 70));
    cells().for_each(|cell| plane.insert(cell));
    let count = plane.count();
    let mut at = (0, 0);
    for (width, height, words, rows) in
        [(128, 5, 0, 0), (128, 9, 0, 4), (256, 9, 1, 0), (448, 12, 2, 1), (448, 14, 0, 0)]
    {
        plane.grow(width, height, (words, rows));
        at = (at.0 + 64 * words as i32, at.1 + rows as i32);
        assert_eq!((plane.width(), plane.height(), plane.words().len()), (width, height, width / 64 * height));
        assert!(plane.count() == count && cells().all(|cell| plane.contains(cell.offset(at))), "{width} x {height}");
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

#[test]
fn bits_that_move_stay_beside_each_other() {
    let mut plane = BitPlane::new(130, 3);
    let cells = || (0..390).filter(|i| i % 7 < 3 || i % 5 == 1).map(|i| Cell::new(i % 130, i / 130));
    cells().for_each(|cell| plane.insert(cell));
    for (columns, rows, behind) in [(0, 0, 0), (1, 0, 0), (62, 1, 0), (63, 0, 2), (64, 2, 1), (65, 0, 70), (200, 3, 0)]
    {
        let moved = plane.moved((columns + 130 + behind, rows + 4), (columns, rows));
        let offset = (columns as i32, rows as i32);
        assert_eq!((moved.width(), moved.height()), (columns + 130 + behind, rows + 4));
        assert!(moved.count() == plane.count() && cells().all(|cell| moved.contains(cell.offset(offset))), "{columns}");
    }
}
