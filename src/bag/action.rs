//! The messages of move_base's action: goals and what became of them.

use super::cursor::{Cursor, Malformed};
use super::message::{Header, StampedPose, stamped};

/// `move_base_msgs/MoveBaseActionGoal`.
#[derive(Clone, Debug, PartialEq)]
pub struct GoalMessage {
    /// The goal's id, by which its result is known.
    pub id: String,
    /// Where to.
    pub target: StampedPose,
}

/// `move_base_msgs/MoveBaseActionResult`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ResultMessage {
    /// Its header.
    pub header: Header,
    /// The goal's id.
    pub id: String,
    /// What became of it, in the numbers of `actionlib_msgs/GoalStatus`: 2 preempted, 3
    /// succeeded, 4 aborted, 5 rejected, 8 recalled.
    pub status: u8,
    /// What the server says about it.
    pub text: String,
}

/// A `move_base_msgs/MoveBaseActionGoal`.
///
/// # Errors
/// [`Malformed`] when it is cut, or its pose no numbers.
pub fn goal(bytes: &[u8]) -> Result<GoalMessage, Malformed> {
    let mut cursor = Cursor::new(bytes);
    cursor.header()?;
    cursor.time("goal_id.stamp")?;
    Ok(GoalMessage { id: cursor.text("goal_id.id")?, target: stamped(&mut cursor)? })
}

/// A `move_base_msgs/MoveBaseActionResult`.
///
/// # Errors
/// [`Malformed`] when it is cut.
pub fn result(bytes: &[u8]) -> Result<ResultMessage, Malformed> {
    let mut cursor = Cursor::new(bytes);
    let header = cursor.header()?;
    cursor.time("goal_id.stamp")?;
    let id = cursor.text("goal_id.id")?;
    let status = *cursor.take(1, "status")?.first().unwrap_or(&0);
    Ok(ResultMessage { header, id, status, text: cursor.text("text")? })
}
