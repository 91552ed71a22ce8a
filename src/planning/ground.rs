//! Which steps a search for the cheapest ways can leave out, by what lies around a cell.
//!
//! Directions are bits, those of [`crate::grid::NEIGHBOURS_8`] from the lowest on. What is
//! left out leads by a dearer way than one round the cell, or by one as dear whose
//! diagonal steps come later (the canonical order of Sturtevant and Rabin 2016).

use super::lattice::ALL_DIRECTIONS as ALL;
use crate::grid::{FREE_COST, INSCRIBED_COST};

const EAST: u8 = 1;
const WEST: u8 = 1 << 1;
const NORTH: u8 = 1 << 2;
const SOUTH: u8 = 1 << 3;
const NORTH_EAST: u8 = 1 << 4;
const NORTH_WEST: u8 = 1 << 5;
const SOUTH_EAST: u8 = 1 << 6;
const SOUTH_WEST: u8 = 1 << 7;

/// What lies around a cell, itself included, and so in which directions it is worth
/// going on. `before`, `here` and `next` are the cells of two steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Ground {
    /// Anything. The cells beside `before` are nearer to it: a step to one of them costs
    /// less than two by way of `here`, as every step costs something.
    Rough,
    /// Passable cells whose costs are at most [`calm_up_to`]. What can be reached from
    /// `before` by one diagonal step, or by two straight ones round a corner, is dearer by
    /// way of `here`.
    Calm,
    /// Open space.
    Space,
}

/// The highest cost around a cell of cost `c` that is calm. With a weight of
/// `(250 + 2 (a + b)) / 250` for a step between costs a and b, and the rounding down of
/// two steps taken off, two diagonal steps by way of c are dearer than two straight ones
/// round it by way of w when 48 w <= 2000 + 68 c; two straight ones by way of c dearer
/// than a diagonal one between costs that sum to s when 10 s <= 1250 + 48 c. Both hold
/// up to 41 + 1.375 c.
const fn calm_up_to(c: u8) -> u8 {
    c.saturating_add(c / 4).saturating_add(c / 8).saturating_add(41)
}

/// The directions to go on in, by the ground of a cell and the direction in which it was
/// entered.
pub const ONWARD: [[u8; 8]; 3] = [ONWARD_ROUGH, ONWARD_CALM, ONWARD_CALM];
/// The same for cells entered from open space.
pub const ONWARD_FROM_SPACE: [[u8; 8]; 3] = [ONWARD_ROUGH, ONWARD_CALM, ONWARD_IN_SPACE];

/// Where nothing is known of the ground.
pub const ONWARD_ROUGH: [u8; 8] = [
    ALL & !(WEST | NORTH_WEST | SOUTH_WEST),
    ALL & !(EAST | NORTH_EAST | SOUTH_EAST),
    ALL & !(SOUTH | SOUTH_EAST | SOUTH_WEST),
    ALL & !(NORTH | NORTH_EAST | NORTH_WEST),
    ALL & !(WEST | SOUTH | SOUTH_WEST),
    ALL & !(EAST | SOUTH | SOUTH_EAST),
    ALL & !(WEST | NORTH | NORTH_WEST),
    ALL & !(EAST | NORTH | NORTH_EAST),
];
const ONWARD_CALM: [u8; 8] = [
    EAST | NORTH_EAST | SOUTH_EAST,
    WEST | NORTH_WEST | SOUTH_WEST,
    NORTH | NORTH_EAST | NORTH_WEST,
    SOUTH | SOUTH_EAST | SOUTH_WEST,
    NORTH | EAST | NORTH_EAST,
    NORTH | WEST | NORTH_WEST,
    SOUTH | EAST | SOUTH_EAST,
    SOUTH | WEST | SOUTH_WEST,
];
const ONWARD_IN_SPACE: [u8; 8] = [
    EAST,
    WEST,
    NORTH,
    SOUTH,
    NORTH | EAST | NORTH_EAST,
    NORTH | WEST | NORTH_WEST,
    SOUTH | EAST | SOUTH_EAST,
    SOUTH | WEST | SOUTH_WEST,
];

/// The open directions and the [`Ground`] of the inner cells of the middle one of three
/// rows. Arithmetic without branches, which the compiler turns into vector code.
pub fn survey(rows: &[Vec<u8>; 3], open: &mut [u8], ground: &mut [u8]) {
    let width = open.len().min(ground.len());
    let part = |row: usize, from: usize| &rows[row][from..from + width];
    let (s_w, s, s_e) = (part(0, 0), part(0, 1), part(0, 2));
    let (w, here, e) = (part(1, 0), part(1, 1), part(1, 2));
    let (n_w, n, n_e) = (part(2, 0), part(2, 1), part(2, 2));
    let (open, ground) = (&mut open[..width], &mut ground[..width]);
    let is_open = |cost: u8| u8::from(cost < INSCRIBED_COST);
    for x in 0..width {
        let (east, west, north, south) = (is_open(e[x]), is_open(w[x]), is_open(n[x]), is_open(s[x]));
        let sides = east | west << 1 | north << 2 | south << 3;
        let north_corners = (north & east & is_open(n_e[x])) << 4 | (north & west & is_open(n_w[x])) << 5;
        let south_corners = (south & east & is_open(s_e[x])) << 6 | (south & west & is_open(s_w[x])) << 7;
        open[x] = sides | north_corners | south_corners;
        let beside = e[x].max(w[x]).max(n[x]).max(s[x]);
        let highest = here[x].max(beside).max(n_e[x]).max(n_w[x]).max(s_e[x]).max(s_w[x]);
        let is_calm = is_open(highest) & u8::from(highest <= calm_up_to(here[x]));
        let is_space = u8::from(highest == FREE_COST);
        ground[x] = is_calm * Ground::Calm as u8 + is_space * (Ground::Space as u8 - Ground::Calm as u8);
    }
}
