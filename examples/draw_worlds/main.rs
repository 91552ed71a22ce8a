//! Draws the worlds in `maps/` anew: `cargo run --example draw_worlds [DIRECTORY]`.
//!
//! The drawings are code, so that a door can be moved and reviewed; a test holds the
//! files in `maps/` against them.

mod canvas;
mod maze;
mod museum;
mod office;
mod warehouse;
mod worlds;

use anyhow::Context;
use frontier_explorer::io::{SaveOptions, save_map};
use std::path::PathBuf;

fn main() -> anyhow::Result<()> {
    let directory = std::env::args_os().nth(1).map_or_else(|| PathBuf::from("maps"), PathBuf::from);
    std::fs::create_dir_all(&directory).with_context(|| format!("cannot create {}", directory.display()))?;
    for (name, draw) in worlds::ALL {
        let grid = draw().with_context(|| format!("cannot draw {name}"))?;
        save_map(&directory.join(name), &grid, &SaveOptions::default())?;
    }
    Ok(())
}
