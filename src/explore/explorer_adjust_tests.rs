//! Settings that are exchanged in the middle of a run.

use super::teleporter::{Teleporter, point_robot};
use super::{HOUSE, *};
use crate::selection::SelectorConfig;

fn changed(change: impl FnOnce(&mut ExplorerSettings)) -> ExplorerSettings {
    let mut settings = ExplorerSettings::default();
    change(&mut settings);
    settings
}

/// A run that has made a few steps.
fn under_way() -> (Teleporter, Explorer) {
    let mut robot = Teleporter::new(HOUSE, 2.5, 2.5);
    let mut explorer = Explorer::new(ExplorerSettings::default(), &point_robot()).unwrap();
    assert!(robot.follow(&mut explorer, 6).is_none());
    (robot, explorer)
}

/// The end of a run whose settings are changed on the way.
fn end_after(change: impl FnOnce(&mut ExplorerSettings)) -> End {
    let (mut robot, mut explorer) = under_way();
    explorer.adjust(&changed(change)).unwrap();
    robot.follow(&mut explorer, 2000).expect("the run did not end")
}

#[test]
fn a_time_limit_that_is_set_on_the_way_counts_from_the_start() {
    let end = end_after(|settings| settings.patience.time_limit_s = Some(8.0));
    assert_eq!((end.reason, end.time_s), (EndReason::TimeLimit, 9.0));
}

#[test]
fn what_suffices_and_what_is_too_small_is_weighed_anew() {
    let end = end_after(|settings| settings.finish.good_enough_share = Some(0.1));
    assert_eq!(end.reason, EndReason::GoodEnough);
    let end = end_after(|settings| {
        settings.detector.min_size_m = 1000.0;
        settings.finish.explore_what_the_audit_sees = false;
    });
    assert_eq!(end.reason, EndReason::PresetSeesNoMore, "{}", end.message);
}

#[test]
fn the_strategy_is_exchanged_and_a_run_still_sees_everything() {
    let (mut robot, mut explorer) = under_way();
    explorer.adjust(&changed(|settings| settings.selection = SelectorConfig::MaxGain {})).unwrap();
    let decision = explorer.step(&robot.observation());
    assert!(decision.record.is_some_and(|record| record.why.contains("max_gain")), "{:?}", explorer.goal());
    robot.obey(&decision.command);
    assert_eq!(robot.follow(&mut explorer, 2000).unwrap().reason, EndReason::Complete);
}

#[test]
fn a_bad_value_and_what_cannot_be_exchanged_change_nothing() {
    let (_, mut explorer) = under_way();
    let error = explorer.adjust(&changed(|settings| settings.patience.stall_s = 0.0)).unwrap_err();
    assert_eq!(error.to_string(), "patience.stall_s is 0: must be finite and > 0");
    let before = explorer.settings.clone();
    assert_eq!(before, ExplorerSettings::default());
    let other = changed(|settings| {
        settings.thresholds.free_max = 10;
        settings.planner = PlannerConfig::HybridAstar(HybridAstarConfig::default());
        settings.detector.name = crate::frontier::DetectorKind::Yamauchi;
    });
    explorer.adjust(&other).unwrap();
    assert_eq!(explorer.settings, before);
}
