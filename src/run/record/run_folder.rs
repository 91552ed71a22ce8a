//! The folder in which an exploration leaves its results.

use super::{RecordError, Trail};
use crate::explore::ExplorerSettings;
use crate::geometry::Pose;
use crate::grid::OccupancyGrid;
use crate::io::{SaveOptions, create_folder, save_map, write_atomic};
use crate::report::{Animation, Beside, FrameLog, HtmlReport, Picture, ReportError, RunRecord, Theme};
use std::path::{Path, PathBuf};

/// A folder that exists, and the name of the animation in it.
pub struct RunFolder {
    folder: PathBuf,
    animation: &'static str,
}

impl RunFolder {
    /// Makes the folder if it is not there.
    ///
    /// # Errors
    /// [`RecordError::Folder`] when the file system refuses.
    pub fn create(path: &Path, animation: &'static str) -> Result<Self, RecordError> {
        create_folder(path).map_err(|source| RecordError::Folder { path: path.to_owned(), source })?;
        Ok(Self { folder: path.to_owned(), animation })
    }

    /// The path of a file in it.
    pub(super) fn path(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    /// The files of an exploration, the report first.
    fn files(&self) -> impl Iterator<Item = PathBuf> + '_ {
        ["report.html", "run.json", "map.yaml", "map.pgm", "map.png", self.animation]
            .into_iter()
            .map(|name| self.path(name))
    }

    /// Writes all results; the map first, as it is what the run was for. The files that were
    /// written, the report first: where no frame was seen, there is no animation.
    pub(super) fn write(
        &self,
        record: &RunRecord,
        trail: &Trail,
        grid: &OccupancyGrid,
        end_in_map: Option<Pose>,
        settings: &ExplorerSettings,
        beside: Option<&Beside>,
    ) -> Result<Vec<PathBuf>, RecordError> {
        save_map(&self.path("map.yaml"), grid, &SaveOptions::default())?;
        self.save("run.json", &record.to_json()?)?;
        let picture = Picture {
            grid,
            thresholds: &settings.thresholds,
            trajectory: &trail.trajectory,
            start_in_map: Some(record.start),
            end_in_map,
            goals: &trail.goals,
            region: settings.region.as_ref(),
            no_go: &settings.no_go,
            theme: Theme::Clear,
        };
        let map_png = picture.to_png()?;
        self.save("map.png", &map_png)?;
        let animation =
            Animation { thresholds: &settings.thresholds, trajectory: &trail.trajectory, theme: Theme::Clear };
        let gif = match animation.to_gif(trail.frames.iter().flat_map(FrameLog::frames)) {
            Ok(gif) => Some(gif),
            Err(ReportError::NoFrames) => None,
            Err(error) => return Err(error.into()),
        };
        if let Some(gif) = &gif {
            self.save(self.animation, gif)?;
        }
        let animation_gif = gif.as_deref();
        let html = HtmlReport { run: record, map_png: &map_png, animation_gif, theme: Theme::Clear, beside };
        self.save("report.html", html.to_html()?.as_bytes())?;
        let animation = gif.is_none().then(|| self.path(self.animation));
        Ok(self.files().filter(|path| Some(path) != animation.as_ref()).collect())
    }

    /// Writes one file; its path.
    pub(super) fn save(&self, name: &str, bytes: &[u8]) -> Result<PathBuf, RecordError> {
        let path = self.path(name);
        write_atomic(&path, bytes).map_err(RecordError::write(&path))?;
        Ok(path)
    }
}
