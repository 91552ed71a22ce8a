//! Comparisons that were never made, for tests.

use super::{ComparedPreset, ComparedRun, ComparedWorld, Comparison, ComparisonPlan, WorldPicture};
use crate::explore::EndReason;
use crate::geometry::Pose;
use crate::report::run_json::{MedianMax, Wall};
use crate::report::series::COVERAGE_SHARES;

/// A plan with one start in each world.
pub fn plan(presets: &[&str], worlds: &[&str], seeds: &[u64]) -> ComparisonPlan {
    let picture = WorldPicture {
        png_base64: "cG5n".to_owned(),
        width_px: 100,
        height_px: 50,
        left_m: 0.0,
        top_m: 5.0,
        m_per_px: 0.1,
    };
    let preset = |name: &&str| ComparedPreset {
        name: (*name).to_owned(),
        settings: serde_json::json!({}),
        is_oracle: *name == "oracle",
    };
    let world = |name: &&str| ComparedWorld {
        name: (*name).to_owned(),
        starts: vec![Pose::new(1.0, 1.0, 0.0)],
        picture: picture.clone(),
    };
    ComparisonPlan {
        robot: "robot".to_owned(),
        slam: None,
        time_limit_s: Some(1000.0),
        presets: presets.iter().map(preset).collect(),
        worlds: worlds.iter().map(world).collect(),
        seeds: seeds.to_vec(),
    }
}

/// A run that covers its world evenly in `end_s` seconds.
pub fn run(index: usize, preset: &str, world: &str, end_s: f64) -> ComparedRun {
    let shares = |scale: f64| COVERAGE_SHARES.iter().map(|(n, s)| ((*n).to_owned(), Some(s * scale))).collect();
    ComparedRun {
        index,
        preset: preset.to_owned(),
        world: world.to_owned(),
        start_number: 1,
        start: Pose::new(1.0, 1.0, 0.0),
        seed: 1,
        end_reason: EndReason::Complete,
        coverage: 1.0,
        sim_time_s: end_s,
        distance_m: end_s / 2.0,
        goals_sent: 5,
        goals_failed: 1,
        collisions: 0,
        time_to_coverage_s: shares(end_s),
        distance_to_coverage_m: shares(end_s / 2.0),
        coverage_over_time: vec![[0.0, 0.0], [end_s, 1.0]],
        trajectory: vec![[1.0, 1.0], [9.0, 4.0]],
        wall: Wall { total_s: 0.5, decision_ms: MedianMax { median: 1.0, max: 2.0 } },
    }
}

/// All runs of a plan; `end_s` tells how long each preset takes, by its index.
pub fn comparison(plan: ComparisonPlan, end_s: impl Fn(usize) -> f64) -> Comparison {
    let runs = plan.runs();
    let made = runs.iter().map(|planned| {
        let (preset, world) = (&plan.presets[planned.preset].name, &plan.worlds[planned.world].name);
        ComparedRun { seed: planned.seed, ..run(planned.index, preset, world, end_s(planned.preset)) }
    });
    let runs = made.collect();
    Comparison { plan, runs }
}
