//! What a run leaves behind for people and programs: pictures, an animation, a JSON
//! file and an HTML report (the rim).
//!
//! Every function here makes bytes from data and touches no file and no clock: the
//! same run gives the same bytes.

mod animation;
mod beside;
mod canvas;
mod chart;
mod comparison;
mod figures;
mod frame_log;
mod html;
mod overlay;
mod picture;
mod plots;
mod run_json;
#[cfg(test)]
mod sample;
mod series;
mod shapes;
mod theme;
mod view;

pub use animation::Animation;
pub use beside::{Beside, BesideRow};
pub use comparison::{
    ComparedPreset, ComparedRun, ComparedWorld, Comparison, ComparisonError, ComparisonPlan, LiangRow, LiangTable,
    Measure, PAIRED, Paired, PlannedRun, Spread, Summary, WorldPicture,
};
pub use frame_log::{Frame, FrameLog};
pub use html::HtmlReport;
pub use overlay::{Overlay, OverlayFrontier};
pub use picture::{Picture, PictureGoal};
pub use run_json::{MedianMax, Notice, RunRecord, SCHEMA_VERSION, Wall};
pub use series::{ByShare, COVERAGE_SHARES, Series, SeriesPoint};
pub use theme::Theme;

/// Cells of margin around what is known of a map.
const MARGIN_CELLS: u32 = 4;

/// Why a report cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// A picture cannot be encoded.
    #[error("cannot encode the PNG picture")]
    Png(#[from] image::ImageError),
    /// The animation cannot be encoded.
    #[error("cannot encode the GIF animation")]
    Gif(#[from] gif::EncodingError),
    /// A run without a single map.
    #[error("an animation needs at least one frame, and there are none")]
    NoFrames,
    /// A chart cannot be drawn.
    #[error("cannot draw a chart: {0}")]
    Plot(String),
    /// The page cannot be filled in.
    #[error("cannot make the HTML report")]
    Template(#[from] minijinja::Error),
    /// A number of the run that is none.
    #[error("{field} of the run is {value}: must be finite")]
    NotFinite {
        /// Which.
        field: &'static str,
        /// What it is.
        value: f64,
    },
    /// A run that cannot be written as JSON, or JSON that is not one.
    #[error("not a run.json: {0}")]
    Json(#[from] serde_json::Error),
    /// A file of another time.
    #[error("run.json has schema version {found}: must be {expected}")]
    SchemaVersion {
        /// The version that the file names.
        found: u32,
        /// The one that can be read.
        expected: u32,
    },
}
