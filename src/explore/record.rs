//! What is written down of a run: every decision with its reasons, and the end.

use crate::frontier::Frontier;
use crate::geometry::{Point, Pose};
use crate::grid::GridInfo;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A point in metres, as reports write it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Position {
    /// Metres.
    pub x: f64,
    /// Metres.
    pub y: f64,
}

impl From<Point> for Position {
    fn from(point: Point) -> Self {
        Self { x: point.x, y: point.y }
    }
}

/// The frontiers that a decision was made on. Their cells are shared with the detection: who
/// draws them makes metres of them.
#[derive(Clone, Debug, Default)]
pub struct SeenFrontiers {
    /// Where the cells lie; `None` where nothing has been detected.
    info: Option<GridInfo>,
    frontiers: Vec<Frontier>,
}

impl SeenFrontiers {
    /// Frontiers of a grid; the id of each stays while it overlaps with what it was.
    #[must_use]
    pub const fn new(info: GridInfo, frontiers: Vec<Frontier>) -> Self {
        Self { info: Some(info), frontiers }
    }

    /// One more frontier of the same grid.
    pub(super) fn push(&mut self, frontier: Frontier) {
        self.frontiers.push(frontier);
    }

    /// The centres of the cells of the frontier with an id, in metres of the map frame; none
    /// where there is no such frontier.
    pub fn cells_of(&self, id: u64) -> impl Iterator<Item = Point> {
        self.centers(self.frontiers.iter().filter(move |frontier| frontier.id == id))
    }

    /// The centres of the cells of all frontiers, in metres of the map frame.
    pub fn cells(&self) -> impl Iterator<Item = Point> {
        self.centers(self.frontiers.iter())
    }

    fn centers<'a>(&'a self, frontiers: impl Iterator<Item = &'a Frontier>) -> impl Iterator<Item = Point> {
        let cells = frontiers.flat_map(|frontier| &frontier.cells);
        cells.filter_map(|&cell| self.info.as_ref().map(|info| info.center(cell)))
    }
}

/// What became of one candidate in one decision.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum CandidateStatus {
    /// The robot is sent there.
    Chosen,
    /// It could have been chosen; another one came before it.
    Eligible,
    /// The planner found no path to it.
    NoPath,
    /// No place to stand near it is connected to the robot.
    Unreachable,
    /// It failed, or was visited in vain, and is left alone for now.
    Taboo,
    /// It lies outside the region to explore.
    OutsideRegion,
    /// The robot's body does not fit through: a crack in a wall, a gap between two legs.
    TooNarrow,
    /// The robot stands where it is seen from: a newer map tells what becomes of it.
    AlreadyThere,
}

/// One frontier as a candidate for the next goal.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CandidateRecord {
    /// The frontier's id: it stays while the frontier overlaps with what it was.
    pub id: u64,
    /// The frontier's representative point.
    pub target: Position,
    /// Where the robot would stand, if it can.
    pub goal: Option<Pose>,
    /// Number of frontier cells.
    pub size_cells: usize,
    /// Cells times resolution.
    pub size_m: f64,
    /// Euclidean distance from the robot to the target, metres.
    pub distance_m: f64,
    /// Length of the planned way to the goal, metres, where it was computed.
    pub path_m: Option<f64>,
    /// The parts of the score by name; `total` orders, the smallest first.
    pub scores: BTreeMap<&'static str, f64>,
    /// What became of it.
    pub status: CandidateStatus,
}

/// One decision: what was seen, what was weighed, what was done and why.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DecisionRecord {
    /// When, seconds.
    pub time_s: f64,
    /// Where the robot was in the map frame.
    pub pose: Pose,
    /// All frontiers, best first where they have a score.
    pub candidates: Vec<CandidateRecord>,
    /// Where the robot is sent, if it drives.
    pub goal: Option<Pose>,
    /// One sentence for the user.
    pub why: String,
}

/// Why a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum EndReason {
    /// No frontier is left that the robot could get to.
    Complete,
    /// Little enough is left, by the share that was asked for.
    GoodEnough,
    /// The preset's own rules forbid to go on, though frontiers are left.
    PresetSeesNoMore,
    /// Frontiers are left, and no way to any of them.
    AllUnreachable,
    /// Frontiers are left, and the robot cannot get away from where it is.
    Stuck,
    /// Frontiers are left, all of them outside the region to explore.
    OutsideRegion,
    /// Nobody carried commands out for too long.
    NoNavigation,
    /// No map came in time.
    NoMap,
    /// The robot did not know where it was for too long.
    NoPose,
    /// The time allowed is over.
    TimeLimit,
    /// The user stopped it.
    Interrupted,
    /// The robot or its middleware went away.
    Disconnected,
    /// The recording ended.
    RecordingEnded,
}

impl EndReason {
    /// Its name, as `run.json` and the status topic write it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Complete => "complete",
            Self::GoodEnough => "good_enough",
            Self::PresetSeesNoMore => "preset_sees_no_more",
            Self::AllUnreachable => "all_unreachable",
            Self::Stuck => "stuck",
            Self::OutsideRegion => "outside_region",
            Self::NoNavigation => "no_navigation",
            Self::NoMap => "no_map",
            Self::NoPose => "no_pose",
            Self::TimeLimit => "time_limit",
            Self::Interrupted => "interrupted",
            Self::Disconnected => "disconnected",
            Self::RecordingEnded => "recording_ended",
        }
    }

    /// Whether all was done that could be asked for.
    #[must_use]
    pub const fn is_success(self) -> bool {
        matches!(self, Self::Complete | Self::GoodEnough | Self::OutsideRegion | Self::RecordingEnded)
    }
}

/// How many frontiers were left at the end, by the reason for leaving them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct LeftBehind {
    /// Frontiers of the last detection.
    pub frontiers: usize,
    /// No place to stand near them is connected to the robot.
    pub unreachable: usize,
    /// Driving there failed too often.
    pub failed: usize,
    /// Seen from nearby, and nothing more could be seen.
    pub exhausted: usize,
    /// Outside the region to explore.
    pub outside_region: usize,
    /// Openings that the robot does not fit through.
    pub too_narrow: usize,
    /// Of all these but the ones outside the region, cells times resolution, metres.
    pub length_m: f64,
    /// The unknown area at most 1.5 m behind these, square metres; counted at the end.
    pub area_m2: f64,
}

/// The end of a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct End {
    /// Why.
    pub reason: EndReason,
    /// When, seconds.
    pub time_s: f64,
    /// What was left.
    pub left_behind: LeftBehind,
    /// One sentence for the user.
    pub message: String,
}

/// What was done in a run, counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Counts {
    /// Goals the robot was sent to.
    pub goals_sent: usize,
    /// Of those, goals it arrived at.
    pub goals_reached: usize,
    /// Of those, goals that were given up for lack of progress or a way.
    pub goals_failed: usize,
    /// Full turns made to look around.
    pub turns: usize,
    /// Recovery turns made because no way was found.
    pub recoveries: usize,
    /// Times that the robot got away from what stood too near.
    #[serde(default)]
    pub back_offs: usize,
    /// Times that frontiers were detected.
    pub detections: usize,
}

impl Counts {
    /// What a file may say was counted: more would soon not fit the numbers.
    const MOST: usize = 1_000_000_000;

    /// The same, with each held within what can have been counted.
    pub(super) fn believable(&self) -> Self {
        let held = |count: usize| count.min(Self::MOST);
        Self {
            goals_sent: held(self.goals_sent),
            goals_reached: held(self.goals_reached),
            goals_failed: held(self.goals_failed),
            turns: held(self.turns),
            recoveries: held(self.recoveries),
            back_offs: held(self.back_offs),
            detections: held(self.detections),
        }
    }
}
