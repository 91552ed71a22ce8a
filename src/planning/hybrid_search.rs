//! A* over poses: the tree of arcs that [`super::HybridAstar`] grows.
//!
//! States are exact poses; two that fall into one bin of the state lattice are one
//! state, of which the cheaper is kept. Expansions cost a handful of pose checks and
//! O(log states); memory grows with the states met, not with the map.

use super::swept::Swept;
use crate::geometry::{Pose, Twist, normalize_angle};
use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap};
use std::hash::{BuildHasherDefault, Hasher};

/// A motion of constant speeds: poses along it in the frame of its beginning.
#[derive(Clone, Debug)]
pub struct Primitive {
    along: Vec<Pose>,
    length_m: f64,
}

impl Primitive {
    /// The motion of `twist` for `duration_s`, with poses at most `spacing_m` apart.
    #[must_use]
    pub fn new(twist: Twist, duration_s: f64, spacing_m: f64) -> Self {
        let length_m = twist.linear_mps * duration_s;
        let count = (length_m / spacing_m).ceil().max(1.0) as usize;
        let at = |i: usize| twist.advance(&Pose::default(), duration_s * i as f64 / count as f64);
        Self { along: (1..=count).map(at).collect(), length_m }
    }

    /// The poses from `start` on, without it; the headings are not normalised.
    fn along(&self, start: Pose) -> impl Iterator<Item = Pose> + '_ {
        let (sin, cos) = start.yaw.sin_cos();
        self.along.iter().map(move |p| {
            let (x, y) = (start.x + cos * p.x - sin * p.y, start.y + sin * p.x + cos * p.y);
            Pose::new(x, y, start.yaw + p.yaw)
        })
    }

    /// Where it ends, when nothing stands on the way.
    fn end(&self, start: Pose, swept: &Swept<'_>) -> Option<Pose> {
        let mut end = start;
        for pose in self.along(start) {
            if !swept.is_free(&pose) {
                return None;
            }
            end = pose;
        }
        Some(normalized(end))
    }
}

fn normalized(pose: Pose) -> Pose {
    Pose { yaw: normalize_angle(pose.yaw), ..pose }
}

/// Everything a search depends on besides its start.
pub struct Task<'a, H, G> {
    /// Where the robot may be.
    pub swept: &'a Swept<'a>,
    /// The motions.
    pub primitives: &'a [Primitive],
    /// Edge of a bin of the state lattice, metres.
    pub lattice_m: f64,
    /// Bins of the heading.
    pub headings: u32,
    /// Metres left to the goal, estimated.
    pub estimate_m: H,
    /// Whether a pose is near enough.
    pub is_goal: G,
}

/// How a search ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// The poses from the start on and their length in metres.
    Found(Vec<Pose>, f64),
    /// There is nothing left to look at.
    Exhausted,
    /// The allowed expansions are spent.
    Limit,
}

/// A bin of the state lattice: column, row, heading.
type Bin = (i32, i32, u32);

/// One state of the tree.
#[derive(Clone, Copy, Debug)]
struct State {
    pose: Pose,
    bin: Bin,
    length_m: f64,
    /// The state before and the motion from there; the root has none.
    parent: Option<(u32, u8)>,
    expanded: bool,
}

/// Lengths and estimates are finite and not negative, and the bits of such numbers
/// are ordered as they are.
const fn order(value_m: f64) -> u64 {
    value_m.to_bits()
}

/// Grows a tree from `start` until a state is near the goal. Every expansion lowers
/// `expansions_left`.
pub fn search<H, G>(task: &Task<'_, H, G>, start: Pose, expansions_left: &mut u32) -> Outcome
where
    H: Fn(&Pose) -> f64,
    G: Fn(&Pose) -> bool,
{
    let bin = |pose: &Pose| {
        let turn = pose.yaw.rem_euclid(std::f64::consts::TAU) / std::f64::consts::TAU;
        let heading = (turn * f64::from(task.headings)).round() as u32 % task.headings;
        ((pose.x / task.lattice_m).floor() as i32, (pose.y / task.lattice_m).floor() as i32, heading)
    };
    let mut states = vec![State { pose: start, bin: bin(&start), length_m: 0.0, parent: None, expanded: false }];
    let mut best: HashMap<Bin, u32, BuildHasherDefault<BinHasher>> = HashMap::default();
    best.insert(bin(&start), 0);
    // Among equal sums the later state, which is farther on its way.
    let mut queue = BinaryHeap::from([(Reverse(order((task.estimate_m)(&start))), 0_u32)]);
    while let Some((_, id)) = queue.pop() {
        let state = states[id as usize];
        if state.expanded || best.get(&state.bin) != Some(&id) {
            continue;
        }
        if (task.is_goal)(&state.pose) {
            return Outcome::Found(unwind(&states, task.primitives, id), state.length_m);
        }
        if *expansions_left == 0 {
            return Outcome::Limit;
        }
        *expansions_left -= 1;
        states[id as usize].expanded = true;
        for (motion, primitive) in task.primitives.iter().enumerate() {
            let Some(pose) = primitive.end(state.pose, task.swept) else { continue };
            let length_m = state.length_m + primitive.length_m;
            let next = states.len() as u32;
            let bin = bin(&pose);
            let known = best.entry(bin).or_insert(next);
            if *known != next && states[*known as usize].length_m <= length_m {
                continue;
            }
            *known = next;
            states.push(State { pose, bin, length_m, parent: Some((id, motion as u8)), expanded: false });
            queue.push((Reverse(order(length_m + (task.estimate_m)(&pose))), next));
        }
    }
    Outcome::Exhausted
}

/// The poses from the root to a state.
fn unwind(states: &[State], primitives: &[Primitive], mut id: u32) -> Vec<Pose> {
    let mut chain = Vec::new();
    while let Some((parent, motion)) = states[id as usize].parent {
        chain.push((parent, motion));
        id = parent;
    }
    let mut poses = vec![states[0].pose];
    for (parent, motion) in chain.into_iter().rev() {
        poses.extend(primitives[motion as usize].along(states[parent as usize].pose).map(normalized));
    }
    poses
}

/// A hasher for bins: their numbers are small and well spread after one multiplication,
/// and nobody chooses them to collide.
#[derive(Clone, Copy, Debug, Default)]
struct BinHasher(u64);

impl Hasher for BinHasher {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.write_u32(u32::from(byte));
        }
    }

    fn write_u32(&mut self, value: u32) {
        // 2^64 divided by the golden ratio (Knuth, volume 3, section 6.4).
        self.0 = (self.0.rotate_left(23) ^ u64::from(value)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    }

    fn write_i32(&mut self, value: i32) {
        self.write_u32(value as u32);
    }
}
