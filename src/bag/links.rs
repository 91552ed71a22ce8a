//! The frames of tf in a bag, counted as tf2 takes transforms in.
//!
//! What tf2 turns away is counted apart. Where a frame had several parents in the course of
//! the bag, the one with most transforms is its parent: one stray message decides nothing.

use super::skew::Skew;
use super::{Nanos, nanos};
use crate::tf::{TransformSample, frame_name};
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};

/// The most frames that are told apart, and the most parents of one.
const MAX_FRAMES: usize = 4096;
const MAX_PARENTS: usize = 16;
/// The most reasons for which transforms were turned away that are told apart.
const MAX_REASONS: usize = 10;

/// A frame and its parent in tf.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct FrameLink {
    /// The frame that it is expressed in.
    pub parent: String,
    /// Whether it came by `/tf_static`.
    pub is_static: bool,
    /// How many transforms.
    pub messages: u64,
    /// The first of them where it is static: it is true from the begin, whenever it was told.
    #[serde(skip)]
    pub fixed: Option<TransformSample>,
    /// How far their stamps are from the recorder's clock.
    #[serde(skip)]
    pub skew: Skew,
}

/// The links while they are counted.
#[derive(Debug, Default)]
pub(super) struct Links {
    /// The parents of each frame, in the order in which they came.
    parents: BTreeMap<String, Vec<FrameLink>>,
    rejected: BTreeMap<String, u64>,
}

impl Links {
    /// Counts a transform.
    pub fn count(&mut self, sample: &TransformSample, topic: &str, is_static: bool, recorded: Nanos) {
        if let Err(error) = sample.check() {
            let reason = format!("{topic}: {error}");
            if self.rejected.len() < MAX_REASONS || self.rejected.contains_key(&reason) {
                *self.rejected.entry(reason).or_default() += 1;
            }
            return;
        }
        let (parent, child) = (frame_name(&sample.parent), frame_name(&sample.child));
        if !self.parents.contains_key(child) {
            if self.parents.len() >= MAX_FRAMES {
                return;
            }
            self.parents.insert(child.to_owned(), Vec::new());
        }
        let Some(links) = self.parents.get_mut(child) else { return };
        let index = links.iter().position(|link| link.parent == parent && link.is_static == is_static);
        let index = match index {
            Some(index) => index,
            None if links.len() >= MAX_PARENTS => return,
            None => {
                let fixed = is_static.then(|| sample.clone());
                links.push(FrameLink { parent: parent.to_owned(), is_static, fixed, ..FrameLink::default() });
                links.len() - 1
            }
        };
        if let Some(link) = links.get_mut(index) {
            link.messages += 1;
            link.skew.add(nanos(sample.stamp_s), recorded);
        }
    }

    /// Each frame with the parent that most transforms name, the last one of several such;
    /// and a sentence for what was turned away and for each frame with more than one parent.
    /// Of parents in a circle, the one of fewest transforms is none.
    pub fn finish(self) -> Tree {
        let mut notes: Vec<String> = Vec::new();
        for (reason, count) in &self.rejected {
            notes.push(format!("{count} transforms are ignored, as tf2 does; {reason}"));
        }
        let mut tree = BTreeMap::new();
        for (child, links) in self.parents {
            if links.iter().any(|link| links.first().is_some_and(|first| first.parent != link.parent)) {
                let all: Vec<String> =
                    links.iter().map(|link| format!("{} ({})", link.parent, link.messages)).collect();
                notes.push(format!("{child} has more than one parent in tf: {}", all.join(", ")));
            }
            if let Some(link) = links.into_iter().max_by_key(|link| link.messages) {
                tree.insert(child, link);
            }
        }
        let mut circular = BTreeSet::new();
        let children: Vec<String> = tree.keys().cloned().collect();
        for child in children {
            if let Some((frame, link)) =
                weakest_of_circle(&tree, &child).and_then(|weakest| tree.remove_entry(&weakest))
            {
                notes.push(format!(
                    "{frame} in {} ({}) closes a circle in tf: it is ignored",
                    link.parent, link.messages
                ));
                circular.insert((frame, link.parent));
            }
        }
        notes.truncate(2 * MAX_REASONS);
        Tree { links: tree, circular, notes }
    }
}

/// The tree of frames.
pub(super) struct Tree {
    /// The frames with their parents.
    pub links: BTreeMap<String, FrameLink>,
    /// Frames and parents that would make a circle of it.
    pub circular: BTreeSet<(String, String)>,
    /// What is odd, a sentence each.
    pub notes: Vec<String>,
}

/// The frame with fewest transforms of the circle that leads from a frame to itself; one that
/// is fixed to its parent needs only one transform.
fn weakest_of_circle(tree: &BTreeMap<String, FrameLink>, frame: &str) -> Option<String> {
    let mut weakest: Option<(&str, &FrameLink)> = None;
    let mut at = frame;
    for _ in 0..tree.len() {
        let (name, link) = tree.get_key_value(at)?;
        if weakest.is_none_or(|(_, least)| (link.is_static, link.messages) < (least.is_static, least.messages)) {
            weakest = Some((name, link));
        }
        at = &link.parent;
        if at == frame {
            return weakest.map(|(name, _)| name.to_owned());
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Pose;

    /// Counts ten transforms of a robot with another one at each of some places.
    fn counted(stray: &TransformSample, at: &[usize]) -> Tree {
        let mut links = Links::default();
        for i in 0..=10 {
            if at.contains(&i) {
                links.count(stray, "/tf", false, 1);
            }
            let stamp_s = 100.0 + i as f64;
            for (parent, child) in [("map", "odom"), ("odom", "base_link")] {
                links.count(&TransformSample::planar(stamp_s, parent, child, &Pose::default()), "/tf", false, 1);
            }
        }
        links.count(stray, "/tf", false, 1);
        links.finish()
    }

    #[test]
    fn what_tf2_ignores_decides_no_parent() {
        let good = TransformSample::planar(105.0, "cup", "base_link", &Pose::default());
        let strays = [
            (TransformSample { parent: "base_link".into(), ..good.clone() }, "the frame base_link is its own parent"),
            (TransformSample { parent: "/".into(), ..good.clone() }, "a transform without a frame's name"),
            (TransformSample { child: String::new(), ..good.clone() }, "a transform without a frame's name"),
            (TransformSample { rotation_xyzw: [f64::NAN; 4], ..good.clone() }, "not finite"),
            (TransformSample { rotation_xyzw: [0.0; 4], ..good.clone() }, "no unit quaternion: its norm is 0.000"),
        ];
        for (stray, reason) in strays {
            let Tree { links: tree, notes, .. } = counted(&stray, &[0, 5]);
            assert_eq!((tree["base_link"].parent.as_str(), tree.len()), ("odom", 2), "{stray:?}");
            assert!(notes.len() == 1 && notes[0].starts_with("3 transforms are ignored") && notes[0].contains(reason));
        }
    }

    #[test]
    fn the_parent_of_most_transforms_counts() {
        let stray = TransformSample::planar(105.0, "cup", "base_link", &Pose::default());
        let Tree { links: tree, notes, .. } = counted(&stray, &[]);
        assert_eq!(tree["base_link"].parent, "odom");
        assert_eq!(notes, ["base_link has more than one parent in tf: odom (11), cup (1)"]);
    }

    #[test]
    fn a_circle_is_opened_where_fewest_transforms_close_it() {
        let stray = TransformSample::planar(105.0, "base_link", "map", &Pose::default());
        let Tree { links, circular, notes } = counted(&stray, &[0]);
        assert_eq!(links.keys().collect::<Vec<_>>(), ["base_link", "odom"]);
        assert!(circular.contains(&("map".to_owned(), "base_link".to_owned())));
        assert_eq!(notes, ["map in base_link (2) closes a circle in tf: it is ignored"]);
    }
}
