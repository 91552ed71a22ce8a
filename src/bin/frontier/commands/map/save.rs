//! `frontier map save`: one map from a ROS topic, as map_saver saves it.

use super::convert::Saving;
use crate::exit::Outcome;
use crate::output;
use anyhow::anyhow;
use frontier_explorer::io::save_map;
use frontier_explorer::ros::{Node, receive_map, stop};
use std::path::PathBuf;
use std::time::Duration;

/// Arguments of `frontier map save`. Remappings such as `map:=/robot/map` work too.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Where to write: FILE.yaml and an image beside it.
    #[arg(short = 'f', value_name = "FILE", default_value = "map")]
    file: PathBuf,
    #[command(flatten)]
    saving: Saving,
    /// The topic of the map.
    #[arg(long, default_value = "map")]
    topic: String,
    /// Give up after so long without a ROS master, or then without a map, seconds.
    #[arg(long, value_name = "S", default_value_t = 30)]
    timeout: u64,
    /// `name:=value`, as ROS takes them.
    #[arg(hide = true)]
    remappings: Vec<String>,
}

/// Runs `frontier map save`.
pub fn run(args: &Args) -> anyhow::Result<Outcome> {
    let options = args.saving.options()?;
    if let Some(stranger) = args.remappings.iter().find(|word| !word.contains(":=")) {
        return Err(anyhow!("{stranger}: must be a remapping such as map:=/robot/map; the file is given with -f"));
    }
    stop::listen().map_err(|why| anyhow!(why))?;
    let patience = Duration::from_secs(args.timeout);
    let node = Node::start_within("frontier_map_save", Some(patience))?;
    let map = receive_map(&node, &args.topic, patience).map_err(|why| anyhow!(why))?;
    let saved = save_map(&args.file, &map.grid, &options)?;
    output::line(format_args!("{}", saved.yaml.display()))?;
    output::line(format_args!("{}", saved.image.display()))?;
    stop::leave_in_time(0);
    node.finish();
    Ok(Outcome::Done)
}
