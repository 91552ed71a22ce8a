//! What a run leaves behind for people and programs: pictures, an animation, a JSON
//! file and an HTML report (the rim).
//!
//! Every function here makes bytes from data and touches no file and no clock: the
//! same run gives the same bytes.

mod animation;
mod canvas;
mod frame_log;
mod overlay;
mod picture;
mod shapes;
mod theme;
mod view;

pub use animation::Animation;
pub use canvas::Canvas;
pub use frame_log::{Frame, FrameLog};
pub use overlay::{Overlay, OverlayFrontier};
pub use picture::{Picture, PictureGoal};
pub use theme::{Ink, Rgb, Theme};
pub use view::{Bounds, SizeLimits, View};

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
}
