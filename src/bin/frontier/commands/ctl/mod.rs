//! `frontier ctl`: what a user may ask of a running explorer.

mod status;

use crate::exit::Outcome;
use crate::{output, ros_node};
use clap::Subcommand;
use frontier_explorer::ros::ctl::request;
use std::time::Duration;

/// Arguments of `frontier ctl`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// What to ask for.
    #[command(subcommand)]
    action: Action,
    /// The explorer.
    #[arg(long, global = true, value_name = "NAME", default_value = "/explore")]
    node: String,
    /// How long to wait for an answer, seconds.
    #[arg(long, global = true, value_name = "S", default_value_t = 10, value_parser = clap::value_parser!(u64).range(1..=3600))]
    timeout: u64,
}

/// What an explorer can be asked for.
#[derive(Debug, Subcommand)]
enum Action {
    /// Begin to explore, or explore again after the end.
    Start,
    /// Let the robot stand until `resume`.
    Pause,
    /// Go on after `pause`.
    Resume,
    /// End the exploration, and save the map.
    Stop,
    /// Drive back to where the exploration began.
    Home,
    /// Print how the exploration is doing.
    Status(status::StatusArgs),
    /// Save the map now.
    Save,
    /// Try again what was given up as out of reach.
    ClearBlacklist,
    /// Say why the robot does what it does.
    Explain,
}

impl Action {
    /// The service that it calls; none for the status, which is a topic.
    const fn service(&self) -> Option<&'static str> {
        Some(match self {
            Self::Start => "start",
            Self::Pause => "pause",
            Self::Resume => "resume",
            Self::Stop => "stop",
            Self::Home => "return_home",
            Self::Save => "save_map",
            Self::ClearBlacklist => "clear_blacklist",
            Self::Explain => "explain",
            Self::Status(_) => return None,
        })
    }
}

/// Runs `frontier ctl`: incomplete where the explorer says no.
pub fn run(args: &Args) -> anyhow::Result<Outcome> {
    let limit = Duration::from_secs(args.timeout);
    ros_node::with("frontier_ctl", |node| {
        let service = match (&args.action, args.action.service()) {
            (Action::Status(status), _) => return status::run(node, &args.node, status, limit),
            (_, Some(service)) => service,
            (_, None) => return Ok(Outcome::Done),
        };
        let answer = request(node, &args.node, service, limit)?;
        output::line(format_args!("{}", answer.message))?;
        Ok(if answer.success { Outcome::Done } else { Outcome::Incomplete })
    })
}
