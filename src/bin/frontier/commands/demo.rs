//! `frontier demo`: a ROS master, `sim_node` and `explore_node` in one process, for those
//! who have no ROS. Whoever has it can look in with rostopic, RViz and the like.

use crate::exit::Outcome;
use crate::{inputs, output, values};
use anyhow::{Context, anyhow, bail};
use frontier_explorer::config::Preset;
use frontier_explorer::io::{load_preset, load_robot, load_world};
use frontier_explorer::nodes::{explore_with, simulate_with};
use frontier_explorer::ros::{Node, start_embedded_master, stop};
use frontier_explorer::sim::{DriverKind, SlamKind};
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

/// Set in the process that has its master's address in `ROS_MASTER_URI`.
const READY: &str = "FRONTIER_DEMO_MASTER_PORT";
/// How long the simulator may take to leave.
const LEAVE_WITHIN: Duration = Duration::from_secs(3);

/// Arguments of `frontier demo`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The world: office, museum, maze, warehouse, or a map_server YAML file.
    #[arg(default_value = "office")]
    world: String,
    /// How to explore: a YAML file, or the name of a built-in preset.
    #[arg(long, value_name = "PRESET", default_value = Preset::DEFAULT, long_help = inputs::preset_help())]
    config: String,
    /// The robot: a YAML file, or the name of a built-in robot.
    #[arg(long, value_name = "ROBOT", default_value = "turtlebot2")]
    robot: String,
    /// matched: a SLAM and a move_base that err as the real ones; or perfect.
    #[arg(long, value_name = "SLAM", default_value = "matched", value_parser = values::slam)]
    slam: SlamKind,
    /// Simulated seconds a real second.
    #[arg(long, default_value_t = 10.0)]
    speed: f64,
    /// The port of the ROS master; 0 takes any that is free.
    #[arg(long, default_value_t = 11311)]
    port: u16,
    /// Where the map is saved at the end: FILE.yaml and FILE.pgm.
    #[arg(long, value_name = "FILE", default_value = "map")]
    map_file: PathBuf,
    /// Stay when the exploration has ended, until Ctrl-C.
    #[arg(long)]
    stay: bool,
}

/// Runs `frontier demo`.
pub fn run(args: &Args) -> anyhow::Result<Outcome> {
    // What is wrong is said before anything begins.
    load_preset(&args.config)?;
    load_robot(&args.robot)?;
    load_world(&args.world)?;
    let Ok(port) = std::env::var(READY) else { return begin_anew(args.port) };
    let port = port.parse().with_context(|| format!("{READY} is {port:?}: must be a port"))?;
    stop::listen().map_err(|why| anyhow!(why))?;
    let uri = start_embedded_master(port)?;
    output::line(format_args!("ROS master at {uri}: export ROS_MASTER_URI={uri} to look in with rostopic or RViz"))?;
    let setup = Node::start("demo")?;
    set_params(&setup, args)?;
    let (sim_node, explorer) = (Node::start("sim")?, Node::start("explore")?);
    let simulating = {
        let node = sim_node.clone();
        std::thread::spawn(move || simulate_with(&node))
    };
    let code = explore_with(&explorer);
    stop::request();
    let limit = std::time::Instant::now() + LEAVE_WITHIN;
    while !simulating.is_finished() && std::time::Instant::now() < limit {
        std::thread::sleep(Duration::from_millis(20));
    }
    if simulating.is_finished()
        && let Ok(Err(error)) = simulating.join()
    {
        return Err(error.into());
    }
    match code? {
        0 => Ok(Outcome::Done),
        3 => Ok(Outcome::Incomplete),
        _ => bail!("the exploration failed: see above"),
    }
}

/// Runs this program again in the same process, with the address of the master that it
/// is to start: rosrust reads it from the environment alone.
fn begin_anew(port: u16) -> anyhow::Result<Outcome> {
    let port = match port {
        0 => std::net::TcpListener::bind(("127.0.0.1", 0))
            .and_then(|listener| listener.local_addr())
            .context("no port is free")?
            .port(),
        port => port,
    };
    let program = std::env::current_exe().context("cannot find this program")?;
    let error = Command::new(program)
        .args(std::env::args_os().skip(1))
        .env(READY, port.to_string())
        .env("ROS_MASTER_URI", format!("http://localhost:{port}"))
        .env("ROS_HOSTNAME", "localhost")
        .exec();
    Err(error).context("cannot begin the demo")
}

fn set_params(setup: &Node, args: &Args) -> anyhow::Result<()> {
    setup.set_param("/use_sim_time", &true)?;
    setup.set_param("/sim/world", &args.world)?;
    setup.set_param("/sim/robot", &args.robot)?;
    setup.set_param("/sim/config", &args.config)?;
    setup.set_param("/sim/speed", &args.speed)?;
    setup.set_param("/sim/slam", &args.slam.name())?;
    setup.set_param("/sim/driver", &DriverKind::beside(args.slam).name())?;
    setup.set_param("/explore/config", &args.config)?;
    setup.set_param("/explore/robot", &args.robot)?;
    setup.set_param("/explore/exit_when_done", &!args.stay)?;
    let file: &Path = &args.map_file;
    setup.set_param("/explore/map_file", &file.to_string_lossy())?;
    Ok(())
}
