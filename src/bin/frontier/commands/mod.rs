//! One file for each command.

pub mod bag;
pub mod bench;
pub mod compare;
pub mod ctl;
pub mod demo;
pub mod detect;
pub mod doctor;
pub mod explore;
pub mod map;
pub mod replay;
pub mod shell;

use crate::args::{Args, Command};
use crate::exit::Outcome;
use clap::CommandFactory;

/// Runs a parsed command.
pub fn run(command: Command) -> anyhow::Result<Outcome> {
    match command {
        Command::Explore(args) => explore::run(&args),
        Command::Compare(args) => compare::run(&args),
        Command::Demo(args) => demo::run(&args),
        Command::Doctor(args) => doctor::run(&args),
        Command::Ctl(args) => ctl::run(&args),
        Command::Detect(args) => detect::run(&args),
        Command::Replay(args) => replay::run(&args),
        Command::Bag(command) => bag::run(&command),
        Command::Bench(command) => bench::run(&command),
        Command::Map(command) => map::run(&command),
        Command::Completions(args) => shell::completions(&args, Args::command()),
        Command::Man(args) => shell::man(&args, Args::command()),
    }
}
