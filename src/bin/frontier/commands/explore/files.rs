//! The folder in which a run leaves its results.

use super::recorder::Recorder;
use anyhow::Context;
use frontier_explorer::explore::ExplorerSettings;
use frontier_explorer::io::{SaveOptions, save_map, write_atomic};
use frontier_explorer::report::{Animation, FrameLog, HtmlReport, Picture, RunRecord, Theme};
use frontier_explorer::sim::SimRobot;
use std::path::{Path, PathBuf};

/// A folder that exists.
pub struct RunFolder(PathBuf);

impl RunFolder {
    /// Makes the folder if it is not there.
    pub fn create(path: &Path) -> anyhow::Result<Self> {
        std::fs::create_dir_all(path).with_context(|| format!("cannot make the folder {}", path.display()))?;
        Ok(Self(path.to_owned()))
    }

    /// The files of a run, the report first.
    pub fn files(&self) -> impl Iterator<Item = PathBuf> + '_ {
        ["report.html", "run.json", "map.yaml", "map.pgm", "map.png", "exploration.gif"]
            .into_iter()
            .map(|name| self.0.join(name))
    }

    /// Writes all results; the map first, as it is what the run was for.
    pub fn write(
        &self,
        record: &RunRecord,
        recorder: &Recorder,
        sim: &SimRobot,
        settings: &ExplorerSettings,
    ) -> anyhow::Result<()> {
        let grid = sim.map();
        save_map(&self.0.join("map.yaml"), grid, &SaveOptions::default())?;
        self.save("run.json", &record.to_json()?)?;
        let picture = Picture {
            grid,
            thresholds: &settings.thresholds,
            trajectory: &recorder.trajectory,
            start_in_map: Some(record.start),
            end_in_map: Some(sim.pose()),
            goals: &recorder.goals,
            region: settings.region.as_ref(),
            theme: Theme::Clear,
        };
        let map_png = picture.to_png()?;
        self.save("map.png", &map_png)?;
        let animation =
            Animation { thresholds: &settings.thresholds, trajectory: &recorder.trajectory, theme: Theme::Clear };
        let gif = animation.to_gif(recorder.frames.iter().flat_map(FrameLog::frames))?;
        self.save("exploration.gif", &gif)?;
        let html = HtmlReport { run: record, map_png: &map_png, animation_gif: Some(&gif), theme: Theme::Clear };
        self.save("report.html", html.to_html()?.as_bytes())
    }

    fn save(&self, name: &str, bytes: &[u8]) -> anyhow::Result<()> {
        let path = self.0.join(name);
        write_atomic(&path, bytes).with_context(|| format!("cannot write {}", path.display()))
    }
}
