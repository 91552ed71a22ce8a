//! The animation of a run as a GIF: the map grows, the robot drives.
//!
//! All frames share one view and one palette. Of each frame after the first, only the
//! rectangle that changed is stored, and in it what did not change is transparent:
//! long stretches of one value, which LZW shortens best.

use super::canvas::Canvas;
use super::frame_log::Frame;
use super::theme::{Ink, Theme};
use super::view::{Bounds, SizeLimits, View};
use super::{MARGIN_CELLS, ReportError};
use crate::geometry::Point;
use crate::grid::{OccupancyGrid, Thresholds};
use std::sync::Arc;

/// How long the whole animation should last, in hundredths of a second, before the
/// last frame is held.
const LENGTH_CS: usize = 1200;

/// How long the last frame is held, in hundredths of a second.
const HOLD_CS: u16 = 300;

/// What is to be shown.
#[derive(Clone, Copy, Debug)]
pub struct Animation<'a> {
    /// What counts as free and as occupied in the maps.
    pub thresholds: &'a Thresholds,
    /// The way driven in the whole run, in the map frame.
    pub trajectory: &'a [Point],
    /// Colours.
    pub theme: Theme,
}

impl Animation<'_> {
    /// Draws the frames as a GIF file that loops for ever, in as many frames as are
    /// given.
    ///
    /// # Errors
    /// [`ReportError::NoFrames`] when there are none, [`ReportError::Gif`] when the
    /// encoder fails.
    pub fn to_gif<'f>(&self, frames: impl IntoIterator<Item = &'f Frame>) -> Result<Vec<u8>, ReportError> {
        let frames: Vec<&Frame> = frames.into_iter().collect();
        let view = view_of(&frames).ok_or(ReportError::NoFrames)?;
        let palette = self.theme.palette();
        let clear = palette.len() as u8;
        let mut colors = palette.concat();
        colors.extend([0; 3]);

        let (width, height) = (view.width_px() as u16, view.height_px() as u16);
        let mut encoder = gif::Encoder::new(Vec::new(), width, height, &colors)?;
        encoder.set_repeat(gif::Repeat::Infinite)?;
        let delay_cs = (LENGTH_CS / frames.len()).clamp(6, 30) as u16;
        let mut map = MapLayer { canvas: Canvas::new(view), drawn: None };
        let mut shown: Option<Canvas> = None;
        for (i, frame) in frames.iter().enumerate() {
            let canvas = self.draw(map.show(&frame.grid, self.thresholds), frame);
            let change = Change::between(shown.as_ref(), &canvas);
            encoder.write_frame(&gif::Frame {
                delay: if i + 1 == frames.len() { HOLD_CS } else { delay_cs },
                dispose: gif::DisposalMethod::Keep,
                transparent: Some(clear),
                left: change.left as u16,
                top: change.top as u16,
                width: change.width as u16,
                height: change.height as u16,
                buffer: change.pixels(shown.as_ref(), &canvas, clear).into(),
                ..gif::Frame::default()
            })?;
            shown = Some(canvas);
        }
        Ok(encoder.into_inner()?)
    }

    /// One frame on its map.
    fn draw(&self, map: &Canvas, frame: &Frame) -> Canvas {
        let mut canvas = map.clone();
        let info = frame.grid.info();
        let frontiers = frame.frontier_points_in_map.iter().map(|&point| info.cell_at(point));
        canvas.fill_cells(info, frontiers, Ink::Frontier);
        let driven = self.trajectory.get(..frame.trajectory_len).unwrap_or(self.trajectory);
        canvas.polyline(driven, 2.0, Ink::Path);
        if let Some(goal) = frame.goal_in_map {
            canvas.cross(goal, 1.8, Ink::Goal);
        }
        if let Some(pose) = &frame.pose_in_map {
            canvas.robot(pose);
        }
        canvas
    }
}

/// The view that shows all that is known in any of the frames.
fn view_of(frames: &[&Frame]) -> Option<View> {
    let first = frames.first()?;
    let mut bounds = Bounds::of_known(&first.grid, MARGIN_CELLS);
    for pair in frames.windows(2) {
        if let [before, after] = pair
            && !Arc::ptr_eq(&before.grid, &after.grid)
        {
            bounds = bounds.union(Bounds::of_known(&after.grid, MARGIN_CELLS));
        }
    }
    let poses = frames.iter().filter_map(|frame| frame.pose_in_map);
    let bounds = poses.fold(bounds, |bounds, pose| bounds.including(pose.position()));
    Some(View::fit(bounds, first.grid.info().resolution_m(), SizeLimits::ANIMATION))
}

/// The map alone, drawn anew only when it is another one.
struct MapLayer {
    canvas: Canvas,
    drawn: Option<Arc<OccupancyGrid>>,
}

impl MapLayer {
    fn show(&mut self, grid: &Arc<OccupancyGrid>, thresholds: &Thresholds) -> &Canvas {
        if !self.drawn.as_ref().is_some_and(|drawn| Arc::ptr_eq(drawn, grid)) {
            self.canvas.clear();
            self.canvas.draw_grid(grid, thresholds);
            self.drawn = Some(Arc::clone(grid));
        }
        &self.canvas
    }
}

/// The rectangle of pixels in which two pictures differ.
struct Change {
    left: usize,
    top: usize,
    width: usize,
    height: usize,
}

impl Change {
    /// The whole picture if there was none before; one pixel if nothing changed, as a
    /// GIF frame has at least one.
    fn between(before: Option<&Canvas>, after: &Canvas) -> Self {
        let (width, height) = (after.view().width_px(), after.view().height_px());
        let Some(before) = before else { return Self { left: 0, top: 0, width, height } };
        let rows = before.pixels().chunks_exact(width).zip(after.pixels().chunks_exact(width));
        let (mut left, mut right, mut top, mut bottom) = (width, 0, height, 0);
        for (y, (old, new)) in rows.enumerate().filter(|(_, (old, new))| old != new) {
            let differs = |(old, new): (&u8, &u8)| old != new;
            left = left.min(old.iter().zip(new).position(differs).unwrap_or(width));
            right = right.max(old.iter().zip(new).rposition(differs).unwrap_or(0));
            top = top.min(y);
            bottom = y;
        }
        if top == height {
            return Self { left: 0, top: 0, width: 1, height: 1 };
        }
        Self { left, top, width: right + 1 - left, height: bottom + 1 - top }
    }

    /// The palette indices in the rectangle, `clear` where nothing changed.
    fn pixels(&self, before: Option<&Canvas>, after: &Canvas, clear: u8) -> Vec<u8> {
        let mut pixels = Vec::with_capacity(self.width * self.height);
        for y in self.top..self.top + self.height {
            let new = after.span(y, self.left..self.left + self.width);
            match before.map(|canvas| canvas.span(y, self.left..self.left + self.width)) {
                Some(old) => pixels.extend(old.iter().zip(new).map(|(o, n)| if o == n { clear } else { *n })),
                None => pixels.extend_from_slice(new),
            }
        }
        pixels
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Pose;
    use crate::report::theme::Rgb;

    fn frames() -> Vec<Frame> {
        let maps = ["????\n.???\n####", "????\n...?\n####", "????\n...?\n####"];
        let maps = maps.map(|map| Arc::new(OccupancyGrid::from_ascii(map).unwrap()));
        maps.iter()
            .enumerate()
            .map(|(i, grid)| Frame {
                time_s: i as f64,
                grid: Arc::clone(grid),
                pose_in_map: (i > 0).then(|| Pose::new(1.5, 1.5, 0.0)),
                trajectory_len: i,
                frontier_points_in_map: Arc::new([Point::new(0.5 + i.min(1) as f64 * 2.0, 1.5)]),
                goal_in_map: None,
            })
            .collect()
    }

    /// What a viewer shows after each frame.
    fn play(bytes: &[u8], theme: Theme) -> Vec<Vec<Rgb>> {
        let mut options = gif::DecodeOptions::new();
        options.set_color_output(gif::ColorOutput::Indexed);
        let mut decoder = options.read_info(bytes).unwrap();
        let width = usize::from(decoder.width());
        let mut screen = vec![[0; 3]; width * usize::from(decoder.height())];
        let palette = theme.palette();
        let mut shown = Vec::new();
        while let Some(frame) = decoder.read_next_frame().unwrap() {
            for (i, &index) in frame.buffer.iter().enumerate() {
                let x = usize::from(frame.left) + i % usize::from(frame.width);
                let y = usize::from(frame.top) + i / usize::from(frame.width);
                if Some(index) != frame.transparent {
                    screen[y * width + x] = palette[usize::from(index)];
                }
            }
            shown.push(screen.clone());
        }
        shown
    }

    #[test]
    fn every_frame_shows_after_decoding_what_was_drawn() {
        let (frames, thresholds) = (frames(), Thresholds::default());
        let trajectory = [Point::new(0.5, 1.5), Point::new(1.5, 1.5)];
        let animation = Animation { thresholds: &thresholds, trajectory: &trajectory, theme: Theme::Clear };
        let bytes = animation.to_gif(&frames).unwrap();
        assert_eq!(bytes, animation.to_gif(&frames).unwrap());
        let shown = play(&bytes, Theme::Clear);
        assert_eq!(shown.len(), frames.len());
        let palette = Theme::Clear.palette();
        for (frame, shown) in frames.iter().zip(shown) {
            let mut map = Canvas::new(view_of(&frames.iter().collect::<Vec<_>>()).unwrap());
            map.draw_grid(&frame.grid, &thresholds);
            let expected = animation.draw(&map, frame);
            let expected: Vec<Rgb> = expected.pixels().iter().map(|&p| palette[usize::from(p)]).collect();
            assert!(expected == shown, "frame at {} s", frame.time_s);
        }
    }

    #[test]
    fn no_frames_are_no_animation() {
        let thresholds = Thresholds::default();
        let animation = Animation { thresholds: &thresholds, trajectory: &[], theme: Theme::Clear };
        assert!(matches!(animation.to_gif(&[]), Err(ReportError::NoFrames)));
    }
}
