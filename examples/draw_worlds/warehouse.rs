//! A warehouse of 60 m x 40 m: two banks of racks with aisles between them, loading
//! bays to the south, goods in staging, and two offices.

use crate::canvas::Canvas;
use frontier_explorer::grid::{GridInfoError, OccupancyGrid};

/// Draws the warehouse.
pub fn draw() -> Result<OccupancyGrid, GridInfoError> {
    let mut c = Canvas::new(61.0, 41.0, 0.2)?;
    c.building([0.5, 0.5, 60.5, 40.5], 0.3);
    racks(&mut c);
    loading_bays(&mut c);
    offices(&mut c);
    packing(&mut c);
    Ok(c.finish())
}

/// Double racks 2.2 m deep and 18 m long, aisles of 3 m, a cross aisle of 4 m.
fn racks(c: &mut Canvas) {
    for row in 0..5 {
        let y = 12.4 + 5.2 * f64::from(row);
        c.block(4.0, y, 18.0, 2.2);
        // One rack of the second bank is half filled and stands open in the middle.
        if row == 2 {
            c.block(26.0, y, 7.0, 2.2);
            c.block(36.0, y, 8.0, 2.2);
        } else {
            c.block(26.0, y, 18.0, 2.2);
        }
    }
    // A single rack along the north wall.
    c.block(4.0, 39.0, 40.0, 1.2);
}

/// Six bays between fins that stand out from the south wall, some with a truck's load
/// in front of them.
fn loading_bays(c: &mut Canvas) {
    for bay in 0..6 {
        let x = 6.0 + 6.0 * f64::from(bay);
        c.wall((x, 0.8), (x, 3.4));
        // The levelling plate makes a niche in the wall.
        c.floor([x + 1.4, 0.65, x + 4.6, 0.8]);
    }
    c.wall((42.0, 0.8), (42.0, 3.4));
    for (x, y) in [(8.0, 6.2), (9.2, 6.2), (8.0, 7.2), (20.4, 6.2), (20.4, 7.2), (32.2, 6.2), (33.4, 6.2), (33.4, 7.2)]
    {
        c.block(x, y, 1.2, 1.0);
    }
    // Two lone pallets and the pillars of the roof.
    c.block(15.0, 5.0, 1.2, 0.8);
    c.block(27.4, 8.6, 0.8, 1.2);
    for x in [12.8, 24.0, 35.2] {
        c.block(x, 9.4, 0.4, 0.4);
    }
    for y in [17.9, 28.3] {
        c.block(23.8, y, 0.4, 0.4);
    }
}

/// Two offices in the north-east corner with a corridor between them.
fn offices(c: &mut Canvas) {
    // Dispatch.
    c.wall((49.0, 32.0), (49.0, 40.2));
    c.wall((48.9, 32.0), (60.2, 32.0));
    c.door((49.0, 35.0), (49.0, 36.2));
    c.door((52.0, 32.0), (53.2, 32.0));
    c.wall((54.6, 32.1), (54.6, 40.2));
    c.door((54.6, 37.0), (54.6, 38.2));
    c.block(50.6, 38.6, 3.0, 1.6);
    c.block(52.8, 34.4, 1.7, 0.8);
    c.block(56.4, 34.2, 2.2, 1.8);
    c.block(58.0, 39.6, 2.2, 0.6);
    // The foreman and the break room, across a corridor of 2.4 m.
    c.wall((48.9, 29.4), (60.2, 29.4));
    c.wall((49.0, 23.0), (49.0, 29.4));
    c.wall((48.9, 23.0), (60.2, 23.0));
    c.door((51.0, 29.4), (52.2, 29.4));
    c.door((49.0, 25.0), (49.0, 26.2));
    c.wall((55.4, 23.0), (55.4, 29.4));
    c.door((55.4, 24.4), (55.4, 25.6));
    c.door((57.0, 29.4), (58.2, 29.4));
    c.block(51.6, 24.6, 1.8, 1.6);
    c.block(53.2, 28.7, 2.1, 0.6);
    c.disc(58.0, 26.4, 0.6);
    c.block(59.4, 23.1, 0.8, 2.2);
}

/// Packing benches and a cage for valuables along the east wall.
fn packing(c: &mut Canvas) {
    for y in [12.0, 15.0, 18.0] {
        c.block(50.0, y, 4.0, 1.0);
    }
    c.block(57.4, 12.6, 1.0, 6.0);
    c.wall((50.0, 2.6), (50.0, 8.0));
    c.wall((49.9, 8.0), (60.2, 8.0));
    c.wall((50.0, 0.8), (50.0, 2.6));
    c.door((50.0, 4.6), (50.0, 5.8));
    c.block(52.4, 2.4, 1.0, 4.0);
    c.block(55.2, 2.4, 1.0, 4.0);
    c.block(58.0, 2.4, 1.0, 4.0);
    // Chargers of the forklifts.
    c.block(0.8, 4.0, 0.6, 5.0);
}
