//! What may be exchanged while a run goes on: a part of the settings, the areas, the strategy, the
//! planner, and what is left alone.

use super::super::blacklist::Blacklisted;
use super::super::record::EndReason;
use super::super::settings::{DetectorSettings, ExplorerSettings, SettingsError};
use super::super::state::State;
use super::Explorer;
use crate::geometry::{Areas, Polygon};
use crate::planning::GlobalPlanner;
use crate::selection::GoalSelector;

impl Explorer {
    /// Goes by other settings from now on, as far as they can be exchanged on the way: the
    /// smallest frontier, `selection`, `goal`, `turns`, `taboo`, `patience`, `finish` and
    /// `return_to_start`. All others stay. Where what is chosen may be another goal now, it decides
    /// anew; a goal that is given up for that is not blamed.
    ///
    /// # Errors
    /// [`SettingsError`] when a setting cannot be; then nothing is changed.
    pub fn adjust(&mut self, wanted: &ExplorerSettings) -> Result<(), SettingsError> {
        let old = &self.settings;
        let new = ExplorerSettings {
            thresholds: old.thresholds,
            detector: DetectorSettings { min_size_m: wanted.detector.min_size_m, ..old.detector },
            planner: old.planner,
            region: old.region.clone(),
            no_go: old.no_go.clone(),
            ..wanted.clone()
        };
        new.validate()?;
        let chooses_otherwise = new.detector != old.detector
            || new.selection != old.selection
            || new.goal != old.goal
            || new.taboo != old.taboo
            || new.finish != old.finish;
        self.lookout.adjust(old, &new);
        self.blacklist.set_config(new.taboo);
        self.settings = new;
        if chooses_otherwise {
            self.decide_anew();
        }
        Ok(())
    }

    /// Keeps to these areas from now on. A goal under way is given up for that, and not blamed.
    pub fn set_areas(&mut self, areas: Areas) {
        if areas == self.settings.areas() {
            return;
        }
        self.lookout.set_areas(&areas);
        (self.settings.region, self.settings.no_go) = (areas.region, areas.no_go);
        self.outside_told = false;
        self.decide_anew();
        // Who was sent home goes home.
        if matches!(&self.state, State::Returning { end, .. } if end.reason != EndReason::Interrupted) {
            self.state = State::Ready;
        }
    }

    /// Where the robot may be.
    #[must_use]
    pub fn areas(&self) -> Areas {
        self.settings.areas()
    }

    /// Explores only inside a region from now on, or everywhere again.
    pub fn set_region(&mut self, region: Option<Polygon>) {
        self.set_areas(Areas { region, ..self.areas() });
    }

    /// The region that is explored, if there is one.
    #[must_use]
    pub const fn region(&self) -> Option<&Polygon> {
        self.settings.region.as_ref()
    }

    /// What failed in this round, with the reasons.
    #[must_use]
    pub fn blacklisted(&self) -> Vec<Blacklisted> {
        self.blacklist.listed()
    }

    /// Tries everything again that is left alone, also what was seen in vain; how many targets
    /// had failed.
    pub fn clear_blacklist(&mut self) -> usize {
        let failed = self.blacklist.clear();
        self.sights.forget();
        self.decide_anew();
        failed
    }

    /// Chooses goals by another strategy than the settings name, such as one of one's own.
    pub fn set_selector(&mut self, selector: Box<dyn GoalSelector>) {
        self.lookout.set_selector(selector);
    }

    /// Asks another planner for the way to a candidate, such as move_base's own.
    pub fn set_planner(&mut self, planner: Box<dyn GlobalPlanner>) {
        self.lookout.set_planner(planner);
    }

    /// Decides on the map that is there, whatever was decided on it.
    fn decide_anew(&mut self) {
        if matches!(self.state, State::Driving(_) | State::Confirming { .. } | State::Pausing { .. }) {
            self.state = State::Ready;
        }
    }
}
