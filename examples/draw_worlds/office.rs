//! An office floor of 20 m x 15 m: rooms on both sides of a corridor, some of them
//! joined by a second door.

use crate::canvas::Canvas;
use frontier_explorer::grid::{GridInfoError, OccupancyGrid};

/// Draws the floor.
pub fn draw() -> Result<OccupancyGrid, GridInfoError> {
    let mut c = Canvas::new(21.0, 16.0, 0.1)?;
    c.building([0.5, 0.5, 20.5, 15.5], 0.2);
    // The corridor between y = 7.05 and 8.85.
    c.wall((0.7, 7.0), (20.3, 7.0));
    c.wall((0.7, 8.9), (20.3, 8.9));
    c.block(10.2, 8.45, 1.2, 0.4);
    south_side(&mut c);
    north_side(&mut c);
    Ok(c.finish())
}

fn south_side(c: &mut Canvas) {
    for x in [4.6, 8.6, 12.5, 14.2] {
        c.wall((x, 0.7), (x, 7.0));
    }
    // A single office.
    c.door((2.2, 7.0), (3.2, 7.0));
    c.block(0.7, 0.7, 1.6, 0.8);
    c.block(0.7, 3.4, 0.8, 1.6);
    c.block(4.05, 0.7, 0.5, 2.0);
    // An office with an island of two desks.
    c.door((6.0, 7.0), (7.0, 7.0));
    c.block(5.7, 2.2, 1.6, 1.6);
    c.block(7.55, 6.45, 1.0, 0.5);
    // Its neighbour, through a door between them.
    c.door((10.0, 7.0), (11.0, 7.0));
    c.door((8.6, 3.2), (8.6, 4.2));
    c.block(8.65, 0.7, 0.8, 1.8);
    c.block(11.65, 0.7, 0.8, 1.8);
    c.block(8.65, 5.0, 0.45, 1.95);
    // A side corridor with the copier at its end.
    c.door((12.55, 7.0), (14.15, 7.0));
    c.block(12.55, 0.7, 0.7, 0.6);
    // The large office, entered from both corridors.
    c.door((16.5, 7.0), (17.5, 7.0));
    c.door((14.2, 2.0), (14.2, 3.0));
    c.block(16.0, 0.7, 1.4, 0.7);
    c.block(18.9, 0.7, 1.4, 0.7);
    c.block(15.7, 3.0, 3.0, 1.4);
    c.block(19.85, 4.2, 0.45, 1.8);
}

fn north_side(c: &mut Canvas) {
    for x in [6.6, 11.6, 14.6] {
        c.wall((x, 8.9), (x, 15.3));
    }
    // An open-plan office with two benches of desks.
    c.door((1.4, 8.9), (2.4, 8.9));
    c.door((4.9, 8.9), (5.9, 8.9));
    c.block(1.9, 10.5, 1.4, 3.2);
    c.block(4.4, 10.5, 1.2, 3.2);
    c.block(2.0, 14.9, 2.4, 0.4);
    // The meeting room.
    c.door((8.6, 8.9), (9.6, 8.9));
    c.door((6.6, 13.2), (6.6, 14.2));
    c.block(8.0, 10.8, 2.2, 2.8);
    c.block(9.2, 14.85, 2.35, 0.45);
    // A store room, and washrooms behind it.
    c.door((12.6, 8.9), (13.6, 8.9));
    c.wall((11.6, 12.05), (14.6, 12.05));
    c.block(11.65, 11.5, 2.9, 0.5);
    c.door((14.6, 13.2), (14.6, 14.2));
    c.wall((11.65, 13.15), (13.0, 13.15));
    c.wall((11.65, 14.2), (13.0, 14.2));
    c.block(14.05, 14.4, 0.5, 0.9);
    // The kitchen.
    c.door((15.6, 8.9), (16.8, 8.9));
    c.door((18.2, 8.9), (19.6, 8.9));
    c.block(16.0, 14.7, 4.3, 0.6);
    c.disc(17.2, 11.8, 0.6);
    c.block(19.45, 10.6, 0.85, 2.4);
}
