//! The detectors by name: what a configuration says, and the detector that it stands for.

use super::{
    Bitplane, Canny, Dbscan, DetectorParams, ExploreLiteSearch, Fast, FrontierDetector, ImageDetector, Wavefront,
    Yamauchi,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The detectors by name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum DetectorKind {
    /// The textbook Wavefront Frontier Detector (Topiwala 2018).
    Wavefront,
    /// The same frontiers from bit planes, at the speed of memory, and repaired where the map
    /// changed.
    #[default]
    Bitplane,
    /// explore_lite's own: a side must be free, and corners suffice to hang together.
    ExploreLite,
    /// A scan of the whole grid (Yamauchi 1997).
    Yamauchi,
    /// Image processing with enclosing circles (Liang 2020).
    Image,
    /// Clusters by density (Alghfeli).
    Dbscan,
    /// Canny edges of the map under the costmap (Northwestern).
    Canny,
    /// The newest scan's contour and what is known already (Keidar and Kaminka 2012).
    Fast,
}

impl DetectorKind {
    /// All detectors, for tables of tests, help and benchmarks.
    pub const ALL: &'static [Self] = &[
        Self::Wavefront,
        Self::Bitplane,
        Self::ExploreLite,
        Self::Yamauchi,
        Self::Image,
        Self::Dbscan,
        Self::Canny,
        Self::Fast,
    ];

    /// Its name in configuration files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Wavefront => "wavefront",
            Self::ExploreLite => "explore_lite",
            Self::Yamauchi => "yamauchi",
            Self::Image => "image",
            Self::Dbscan => "dbscan",
            Self::Canny => "canny",
            Self::Fast => "fast",
            Self::Bitplane => "bitplane",
        }
    }

    /// A detector of this kind.
    #[must_use]
    pub fn build(self, params: &DetectorParams) -> Box<dyn FrontierDetector> {
        match self {
            Self::Wavefront => Box::new(Wavefront::new(*params)),
            Self::ExploreLite => Box::new(ExploreLiteSearch::new(*params)),
            Self::Yamauchi => Box::new(Yamauchi::new(*params)),
            Self::Image => Box::new(ImageDetector::new(*params)),
            Self::Dbscan => Box::new(Dbscan::new(*params)),
            Self::Canny => Box::new(Canny::new(*params)),
            Self::Fast => Box::new(Fast::new(*params)),
            Self::Bitplane => Box::new(Bitplane::new(*params)),
        }
    }
}
