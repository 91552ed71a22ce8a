//! What each control does in each state of the node: a table, and no more.

use super::desk::Control;

/// What the node is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Not started yet.
    Idle,
    /// Started, and the first map or the robot's place in it is waited for.
    Waiting,
    /// Exploring.
    Exploring,
    /// On the way back to the start.
    Returning,
    /// The exploration has ended.
    Ended,
}

impl Stage {
    /// All of them.
    #[cfg(test)]
    const ALL: [Self; 5] = [Self::Idle, Self::Waiting, Self::Exploring, Self::Returning, Self::Ended];

    /// Whether an exploration is under way.
    #[must_use]
    pub const fn is_under_way(self) -> bool {
        matches!(self, Self::Waiting | Self::Exploring | Self::Returning)
    }
}

/// What a control does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    /// Nothing.
    None,
    /// An exploration begins; one that is under way ends before.
    Begin,
    /// The robot stands, and all timers with it.
    Pause,
    /// The rest is over.
    GoOn,
    /// The exploration ends.
    End,
    /// The exploration ends, and the robot drives back to the start.
    DriveHome,
    /// What failed may be tried again.
    Forget,
    /// The explanation is told.
    Explain,
}

/// What a control does in a state, and what is answered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rule {
    /// Whether it is as was asked for afterwards.
    pub success: bool,
    /// What is done.
    pub effect: Effect,
    /// What is said.
    pub says: &'static str,
}

const fn yes(effect: Effect, says: &'static str) -> Rule {
    Rule { success: true, effect, says }
}

const fn no(says: &'static str) -> Rule {
    Rule { success: false, effect: Effect::None, says }
}

/// The rule for a control in a state.
#[must_use]
pub const fn rule(control: Control, stage: Stage, is_paused: bool) -> Rule {
    match (control, stage) {
        (Control::Explain, _) => yes(Effect::Explain, ""),
        (Control::Start | Control::Resume, Stage::Waiting | Stage::Exploring | Stage::Returning)
            if is_paused && !matches!((control, stage), (Control::Start, Stage::Returning)) =>
        {
            yes(Effect::GoOn, "going on")
        }
        (Control::Start | Control::Resume, Stage::Idle) => yes(Effect::Begin, "the exploration begins"),
        (Control::Start | Control::Resume, Stage::Ended) => yes(Effect::Begin, "another exploration begins"),
        (Control::Start | Control::Resume, Stage::Waiting) => {
            yes(Effect::None, "it is started already, and waits for the first map and the robot's place in it")
        }
        (Control::Start | Control::Resume, Stage::Exploring) => yes(Effect::None, "it is exploring already"),
        (Control::Start, Stage::Returning) => yes(Effect::Begin, "the way back is left: another exploration begins"),
        (Control::Resume, Stage::Returning) => yes(Effect::None, "it is on the way back to the start already"),

        (Control::Pause, Stage::Waiting | Stage::Exploring | Stage::Returning) if is_paused => {
            yes(Effect::None, "it is paused already")
        }
        (Control::Pause, Stage::Waiting | Stage::Exploring | Stage::Returning) => {
            yes(Effect::Pause, "paused: the robot stands until ~resume")
        }
        (Control::Pause, Stage::Idle) => no("nothing to pause: the exploration has not been started"),
        (Control::Pause, Stage::Ended) => no("nothing to pause: the exploration has ended"),

        (Control::Stop, Stage::Waiting | Stage::Exploring | Stage::Returning) => yes(Effect::End, "stopped"),
        (Control::Stop, Stage::Idle) => no("nothing to stop: the exploration has not been started"),
        (Control::Stop, Stage::Ended) => no("nothing to stop: the exploration has ended"),

        (Control::ReturnHome, Stage::Exploring) => {
            yes(Effect::DriveHome, "the exploration ends, and the robot drives back to the start")
        }
        (Control::ReturnHome, Stage::Ended) => yes(Effect::DriveHome, "the robot drives back to the start"),
        (Control::ReturnHome, Stage::Returning) if is_paused => {
            yes(Effect::GoOn, "going on with the way back to the start")
        }
        (Control::ReturnHome, Stage::Returning) => yes(Effect::None, "it is on the way back to the start already"),
        (Control::ReturnHome, Stage::Idle) => no("no start is known: the exploration has not been started"),
        (Control::ReturnHome, Stage::Waiting) => no("no start is known: the robot's place is not known yet"),

        (Control::ClearBlacklist, Stage::Waiting | Stage::Exploring | Stage::Returning) => yes(Effect::Forget, ""),
        (Control::ClearBlacklist, Stage::Idle | Stage::Ended) => {
            yes(Effect::None, "nothing is left alone: each exploration begins with an empty list")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CONTROLS: [Control; 7] = [
        Control::Start,
        Control::Pause,
        Control::Resume,
        Control::Stop,
        Control::ReturnHome,
        Control::ClearBlacklist,
        Control::Explain,
    ];

    #[test]
    fn what_is_under_way_can_be_paused_stopped_and_resumed() {
        for stage in Stage::ALL {
            let effect = |control, is_paused| rule(control, stage, is_paused).effect;
            let under_way = stage.is_under_way();
            assert_eq!(effect(Control::Stop, false) == Effect::End, under_way, "{stage:?}");
            assert_eq!(effect(Control::Stop, true) == Effect::End, under_way, "{stage:?}");
            assert_eq!(effect(Control::Pause, false) == Effect::Pause, under_way, "{stage:?}");
            assert_eq!(effect(Control::Pause, true), Effect::None, "{stage:?}");
            assert_eq!(effect(Control::Resume, true) == Effect::GoOn, under_way, "{stage:?}");
            assert_eq!(effect(Control::Resume, false) == Effect::Begin, !under_way, "{stage:?}");
        }
    }

    #[test]
    fn nothing_is_answered_with_no_that_was_done_and_everything_says_something() {
        for (control, stage) in CONTROLS.into_iter().flat_map(|c| Stage::ALL.map(|stage| (c, stage))) {
            for is_paused in [false, true] {
                let Rule { success, effect, says } = rule(control, stage, is_paused);
                assert!(success || effect == Effect::None, "{control:?} {stage:?}");
                let is_told_by_count = matches!(effect, Effect::Forget | Effect::Explain);
                assert_eq!(says.is_empty(), is_told_by_count, "{control:?} {stage:?}");
            }
        }
    }

    #[test]
    fn a_start_leaves_the_way_back_and_home_is_where_it_is_known() {
        assert_eq!(rule(Control::Start, Stage::Returning, true).effect, Effect::Begin);
        assert_eq!(rule(Control::Resume, Stage::Returning, true).effect, Effect::GoOn);
        let home = |stage| rule(Control::ReturnHome, stage, false);
        assert_eq!(home(Stage::Exploring).effect, Effect::DriveHome);
        assert_eq!(home(Stage::Ended).effect, Effect::DriveHome);
        assert!(!home(Stage::Idle).success && !home(Stage::Waiting).success);
        assert_eq!(rule(Control::ReturnHome, Stage::Returning, true).effect, Effect::GoOn);
    }
}
