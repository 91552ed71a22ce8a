//! What goes wrong in a run, and when: drawn by a seed.

use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg32;

/// Nothing goes wrong later than this, simulated seconds.
const HORIZON_S: f64 = 160.0;
/// A pause, and the time from a kill to the next start, are shorter than this, simulated seconds.
const LONGEST_PAUSE_S: f64 = 15.0;
/// One run of so many has a fault that stays.
const STAYS_ONE_IN: u32 = 5;
/// What `sim_node`'s `~fault` can do, the longest that it lasts where it passes, in simulated
/// seconds below the patience of the explorer, and the ends that are right where it stays.
const FAULTS: &[(&str, f64, &[&str])] = &[
    ("drop_tf", 25.0, &["no_pose"]),
    ("abort_goals", 25.0, &["all_unreachable", "stuck"]),
    ("hang", 25.0, &["all_unreachable", "stuck"]),
    ("dead_move_base", 25.0, &["no_navigation"]),
    ("stop_map", 25.0, &["no_map"]),
];

/// What is done to the nodes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Action {
    /// `sim_node` misbehaves from now on, or no more.
    Fault(&'static str),
    /// SIGKILL for `explore_node`.
    Kill,
    /// Another `explore_node` goes on with the session.
    Restart,
    /// The service `~pause`.
    Pause,
    /// The service `~resume`.
    Resume,
}

/// The faults of one run.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Simulated seconds after the start, ascending.
    pub actions: Vec<(f64, Action)>,
    /// The ends beside `complete` that are right: where a fault stays.
    pub ends: &'static [&'static str],
}

impl Plan {
    /// A fault of the simulated robot about every 20 s, and beside these, so that they meet, a
    /// kill or a pause about every 40 s.
    pub fn drawn(seed: u64) -> Self {
        let mut random = Pcg32::seed_from_u64(seed);
        let mut actions = Vec::new();
        let mut ends: &[&str] = &[];
        let mut stays_from_s = f64::INFINITY;
        let stays = random.random_range(0..STAYS_ONE_IN) == 0;
        let mut now_s = random.random_range(1.0..15.0);
        while now_s < HORIZON_S {
            let (name, longest_s, right_ends) = FAULTS[random.random_range(0..FAULTS.len())];
            actions.push((now_s, Action::Fault(name)));
            if stays && now_s > HORIZON_S / 6.0 {
                (ends, stays_from_s) = (right_ends, now_s);
                break;
            }
            now_s += random.random_range(2.0..longest_s);
            actions.push((now_s, Action::Fault("none")));
            now_s += random.random_range(3.0..12.0);
        }
        let mut now_s = random.random_range(3.0..40.0);
        while now_s < HORIZON_S {
            // A new explorer waits for the first map and transform however long: none is started
            // where a fault stays.
            let is_kill = random.random_range(0..2) == 0 && now_s + LONGEST_PAUSE_S < stays_from_s;
            let (first, then) = if is_kill { (Action::Kill, Action::Restart) } else { (Action::Pause, Action::Resume) };
            actions.push((now_s, first));
            now_s += random.random_range(0.5..LONGEST_PAUSE_S);
            actions.push((now_s, then));
            now_s += random.random_range(15.0..45.0);
        }
        actions.sort_by(|a, b| a.0.total_cmp(&b.0));
        Self { actions, ends }
    }
}
