//! Commands under way: who carries them out, and how they are doing.

use super::RosRobot;
use crate::geometry::Pose;
use crate::robot::{Command, CommandId, Navigation, NavigationState};
use crate::ros::turn_goals::TurnGoals;

/// Which command is under way, and who carries it out.
pub(super) enum Task {
    None,
    /// A goal that move_base has not been sent yet, with the reason.
    Unsent {
        id: CommandId,
        why: String,
    },
    Goal(CommandId),
    Turn(CommandId, TurnGoals),
    Pilot,
    /// What the settings do not allow.
    Refused(CommandId),
}

impl RosRobot {
    /// How the command under way is doing.
    pub(super) fn navigation(&mut self) -> Navigation {
        let (Some(move_base), frame) = (&mut self.parts.move_base, self.parts.map.frame()) else {
            return self.parts.pilot.navigation();
        };
        match &mut self.task {
            Task::None => Navigation { command: 0, state: NavigationState::Idle },
            Task::Unsent { id, why } => Navigation { command: *id, state: NavigationState::Unavailable(why.clone()) },
            Task::Goal(id) => Navigation { command: *id, state: move_base.state() },
            Task::Turn(id, turn) => Navigation { command: *id, state: turn.advance(move_base, frame) },
            Task::Pilot => self.parts.pilot.navigation(),
            Task::Refused(id) => {
                Navigation { command: *id, state: NavigationState::Aborted("~back_off is false".to_owned()) }
            }
        }
    }

    /// Sends a goal to move_base, unless it is under way there.
    pub(super) fn drive(&mut self, id: CommandId, goal_in_map: &Pose) {
        let Some(move_base) = &mut self.parts.move_base else { return };
        if matches!(self.task, Task::Goal(under_way) if under_way == id) && !move_base.is_lost() {
            return;
        }
        self.parts.pilot.command(&Command::Hold);
        self.task = match move_base.send(goal_in_map, self.parts.map.frame()) {
            Ok(()) => Task::Goal(id),
            Err(why) => Task::Unsent { id, why },
        };
        if matches!(self.task, Task::Goal(_)) {
            self.count_goal(id);
            self.note_latency();
        }
    }

    /// A goal has been sent; one that is sent again is no other.
    pub(super) fn count_goal(&mut self, id: CommandId) {
        if self.sent.0 != id {
            self.sent = (id, self.sent.1 + 1);
        }
    }

    /// A goal that the newest map led to has just been sent.
    fn note_latency(&mut self) {
        if let (true, Some(received)) = (self.map_is_new, self.parts.map.received()) {
            self.latencies_ms.push(1e3 * received.arrived.elapsed().as_secs_f64());
        }
    }

    /// Gets away from what stands too near by velocity commands, where that is allowed.
    pub(super) fn back_off(&mut self, command: &Command, id: CommandId) {
        if let Some(move_base) = &mut self.parts.move_base {
            move_base.cancel();
        }
        if let (Some(move_base), true) = (&self.parts.move_base, self.config.tuning.now().clear_costmaps)
            && !matches!(self.task, Task::Pilot)
        {
            move_base.clear_costmaps();
        }
        self.task = if self.config.back_off {
            self.parts.pilot.command(command);
            Task::Pilot
        } else {
            Task::Refused(id)
        };
    }

    /// Turns on the spot, unless that turn is under way.
    pub(super) fn turn(&mut self, id: CommandId, angle_rad: f64) {
        let by_goals = self.config.turn_by_goals;
        let (Some(move_base), true, Some(pose)) = (&mut self.parts.move_base, by_goals, self.pose) else {
            if let Some(move_base) = &mut self.parts.move_base {
                move_base.cancel();
            }
            self.parts.pilot.command(&Command::Turn { id, angle_rad });
            self.task = Task::Pilot;
            return;
        };
        let under_way = match &self.task {
            Task::Turn(current, turn) => *current == id && !turn.is_lost(),
            _ => false,
        };
        if under_way {
            return;
        }
        let mut turn = TurnGoals::new(&pose, angle_rad);
        self.task = match turn.begin(move_base, self.parts.map.frame()) {
            Ok(()) => Task::Turn(id, turn),
            Err(why) => Task::Unsent { id, why },
        };
    }

    /// Asks move_base to forget obstacles that are no more, when it gave a goal up.
    pub(super) fn recover(&self, navigation: &Navigation) {
        let (Some(move_base), true) = (&self.parts.move_base, self.config.tuning.now().clear_costmaps) else { return };
        if let NavigationState::Aborted(why) = &navigation.state {
            self.node.log().warn(format_args!("move_base gave the goal up: {why}"));
            move_base.clear_costmaps();
        }
    }
}
