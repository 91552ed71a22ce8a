//! A museum of 24 m x 18 m: a hall with free-standing showcases, a foyer with shop and
//! cloakroom, and an enfilade of three side rooms.

use crate::canvas::Canvas;
use frontier_explorer::grid::{GridInfoError, OccupancyGrid};

/// Draws the museum.
pub fn draw() -> Result<OccupancyGrid, GridInfoError> {
    let mut c = Canvas::new(25.0, 19.0, 0.2)?;
    c.building([0.5, 0.5, 24.5, 18.5], 0.3);
    c.wall((0.8, 4.8), (17.6, 4.8));
    c.wall((17.6, 0.8), (17.6, 18.2));
    hall(&mut c);
    entrance(&mut c);
    side_rooms(&mut c);
    Ok(c.finish())
}

fn hall(c: &mut Canvas) {
    // Showcases along the way from the foyer.
    c.block(3.0, 7.2, 2.0, 1.0);
    c.block(7.0, 7.0, 1.6, 1.0);
    c.block(10.6, 7.0, 1.6, 1.0);
    c.block(14.2, 7.2, 1.4, 1.0);
    // The great exhibit under four columns.
    c.disc(9.0, 11.8, 1.3);
    for (x, y) in [(6.2, 9.7), (11.4, 9.7), (6.2, 13.5), (11.4, 13.5)] {
        c.block(x, y, 0.4, 0.4);
    }
    // Two partitions with a showcase behind each.
    c.wall((4.2, 10.0), (4.2, 14.0));
    c.block(1.9, 11.4, 1.0, 1.6);
    c.wall((13.8, 10.0), (13.8, 14.0));
    c.block(15.2, 11.2, 1.0, 1.8);
    c.block(3.0, 15.5, 2.0, 1.0);
    c.block(8.0, 15.5, 2.0, 1.0);
    c.disc(13.6, 16.0, 0.55);
    // Cases along the walls.
    c.block(0.8, 6.6, 0.5, 2.4);
    c.block(5.8, 17.7, 6.4, 0.5);
}

fn entrance(c: &mut Canvas) {
    c.wall((6.0, 0.8), (6.0, 4.8));
    c.wall((13.0, 0.8), (13.0, 4.8));
    // The foyer with its desk, wide open to the hall.
    c.door((8.0, 4.8), (11.0, 4.8));
    c.block(8.6, 1.8, 1.8, 0.9);
    // The shop.
    c.door((6.0, 2.0), (6.0, 3.6));
    c.door((2.5, 4.8), (3.7, 4.8));
    c.block(2.2, 1.9, 1.6, 0.9);
    c.block(0.8, 1.6, 0.4, 2.2);
    // The cloakroom with its racks.
    c.door((13.0, 2.0), (13.0, 3.2));
    c.block(14.6, 0.8, 0.5, 2.4);
    c.block(16.1, 0.8, 0.5, 2.4);
}

fn side_rooms(c: &mut Canvas) {
    c.wall((17.6, 6.3), (24.2, 6.3));
    c.wall((17.6, 12.2), (24.2, 12.2));
    c.door((20.2, 6.3), (21.6, 6.3));
    c.door((20.2, 12.2), (21.6, 12.2));
    c.door((17.6, 5.0), (17.6, 6.1));
    c.door((17.6, 8.5), (17.6, 10.1));
    c.door((17.6, 14.6), (17.6, 16.2));
    // From south to north.
    c.block(19.4, 2.2, 1.4, 1.4);
    c.block(22.0, 2.2, 1.0, 1.4);
    c.disc(20.9, 9.2, 0.9);
    c.block(23.6, 7.6, 0.6, 3.2);
    c.wall((19.2, 14.6), (22.6, 14.6));
    c.block(19.9, 16.2, 2.0, 0.8);
}
