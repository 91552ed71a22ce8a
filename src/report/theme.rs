//! Colours of the pictures: what is drawn, and in which colour.
//!
//! [`Theme::Clear`] builds on the palette of Okabe and Ito ("Color Universal Design",
//! 2008), which stays legible with every common colour vision deficiency;
//! [`Theme::Paper`] is that of Fig. 7 of Topiwala 2018.

/// What a pixel shows; the discriminant is its index in the palette. The first three
/// are in the order of their importance when several cells share a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum Ink {
    /// Territory not seen.
    Unknown = 0,
    /// Free territory.
    Free = 1,
    /// Obstacles.
    Occupied = 2,
    /// Frontier cells.
    Frontier = 3,
    /// The way driven.
    Path = 4,
    /// The present goal, or one that was reached.
    Goal = 5,
    /// What is left alone: failed goals and frontiers that are taboo.
    Taboo = 6,
    /// The robot.
    Robot = 7,
    /// The light rim that sets marks off from what is under them.
    Halo = 8,
    /// The outline of the region to explore.
    Region = 9,
}

/// Number of colours of the gradient along a trajectory.
const GRADIENT_LEN: u8 = 48;

/// Palette index of the gradient's first colour.
const GRADIENT_START: u8 = Ink::Region as u8 + 1;

impl Ink {
    /// The index of this ink in a theme's palette.
    #[must_use]
    pub const fn index(self) -> u8 {
        self as u8
    }

    /// The palette index for a place along a trajectory: 0 at its start, 1 at its end.
    #[must_use]
    pub fn along(share: f64) -> u8 {
        GRADIENT_START + (share.clamp(0.0, 1.0) * f64::from(GRADIENT_LEN - 1)).round() as u8
    }
}

/// A set of colours.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Theme {
    /// Light free space, grey unknown, dark walls.
    #[default]
    Clear,
    /// Fig. 7 of Topiwala 2018: frontiers green, free blue, obstacles red.
    Paper,
}

/// Red, green and blue, 0..=255 each.
pub type Rgb = [u8; 3];

impl Theme {
    /// All themes.
    pub const ALL: [Self; 2] = [Self::Clear, Self::Paper];

    /// The name for a command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Clear => "clear",
            Self::Paper => "paper",
        }
    }

    /// The theme with a name, if there is one.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|theme| theme.name() == name)
    }

    /// The colour of an ink.
    #[must_use]
    pub(crate) const fn color(self, ink: Ink) -> Rgb {
        match (self, ink) {
            (Self::Clear, Ink::Unknown) => [0xb4, 0xb8, 0xbe],
            (Self::Clear, Ink::Free) => [0xfa, 0xfa, 0xf7],
            (Self::Clear, Ink::Occupied) => [0x22, 0x26, 0x2e],
            (Self::Clear, Ink::Frontier) => [0x00, 0x9e, 0x73],
            (Self::Clear, Ink::Path) => [0x00, 0x72, 0xb2],
            (Self::Clear, Ink::Robot) => [0x0b, 0x3c, 0x6b],
            (Self::Clear, Ink::Region) => [0x6a, 0x51, 0xa3],
            (Self::Paper, Ink::Unknown) => [0xcc, 0xcc, 0xcc],
            (Self::Paper, Ink::Free) => [0x3f, 0x5f, 0xe0],
            (Self::Paper, Ink::Occupied) => [0xd8, 0x1e, 0x1e],
            (Self::Paper, Ink::Frontier) => [0x1f, 0xe0, 0x4a],
            (Self::Paper, Ink::Path) => [0xff, 0xf2, 0xb0],
            (Self::Paper, Ink::Robot) => [0x10, 0x10, 0x28],
            (Self::Paper, Ink::Region) => [0x30, 0x10, 0x50],
            (_, Ink::Goal) => [0xd0, 0x12, 0x7c],
            (_, Ink::Taboo) => [0xe6, 0x8a, 0x00],
            (_, Ink::Halo) => [0xff, 0xff, 0xff],
        }
    }

    /// All colours, by palette index.
    #[must_use]
    pub(crate) fn palette(self) -> Vec<Rgb> {
        let inks = [
            Ink::Unknown,
            Ink::Free,
            Ink::Occupied,
            Ink::Frontier,
            Ink::Path,
            Ink::Goal,
            Ink::Taboo,
            Ink::Robot,
            Ink::Halo,
            Ink::Region,
        ];
        let steps = f64::from(GRADIENT_LEN - 1);
        let gradient = (0..GRADIENT_LEN).map(|i| self.gradient(f64::from(i) / steps));
        inks.into_iter().map(|ink| self.color(ink)).chain(gradient).collect()
    }

    /// The colours a trajectory runs through, at shares 0, 1/2 and 1 of it.
    #[must_use]
    pub(crate) const fn gradient_stops(self) -> [Rgb; 3] {
        match self {
            Self::Clear => [[0x56, 0xb4, 0xe9], [0x00, 0x72, 0xb2], [0x3a, 0x0f, 0x5c]],
            Self::Paper => [[0xff, 0xff, 0xff], [0xff, 0xe0, 0x50], [0x20, 0x10, 0x20]],
        }
    }

    /// The colour at a share of the trajectory.
    fn gradient(self, share: f64) -> Rgb {
        let [start, middle, end] = self.gradient_stops();
        let (a, b, t) = if share < 0.5 { (start, middle, share * 2.0) } else { (middle, end, share * 2.0 - 1.0) };
        std::array::from_fn(|i| match (a.get(i), b.get(i)) {
            (Some(&a), Some(&b)) => (f64::from(a) + (f64::from(b) - f64::from(a)) * t).round() as u8,
            _ => 0,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_palette_is_ordered_by_ink() {
        for theme in Theme::ALL {
            let palette = theme.palette();
            assert_eq!(palette.len(), usize::from(Ink::along(1.0)) + 1);
            for ink in [Ink::Unknown, Ink::Occupied, Ink::Halo, Ink::Region] {
                assert_eq!(palette[usize::from(ink.index())], theme.color(ink));
            }
            assert_eq!(palette[usize::from(Ink::along(0.0))], theme.gradient_stops()[0]);
            assert_eq!(palette[usize::from(Ink::along(1.0))], theme.gradient_stops()[2]);
        }
    }

    #[test]
    fn names_lead_back() {
        for theme in Theme::ALL {
            assert_eq!(Theme::from_name(theme.name()), Some(theme));
        }
        assert_eq!(Theme::from_name("Paper"), None);
    }
}
