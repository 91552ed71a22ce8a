//! `frontier completions` and `frontier man`: what a shell and `man` need to know of the
//! command line.

use crate::exit::Outcome;
use crate::output;
use anyhow::Context;
use clap_complete::{Shell, generate};
use std::path::PathBuf;

/// Arguments of `frontier completions`.
#[derive(Debug, clap::Args)]
pub struct CompletionsArgs {
    /// For which shell.
    shell: Shell,
}

/// Arguments of `frontier man`.
#[derive(Debug, clap::Args)]
pub struct ManArgs {
    /// The folder for the pages, such as `~/.local/share/man/man1`; it must exist.
    folder: PathBuf,
}

/// Prints the completions of a command line.
pub fn completions(args: &CompletionsArgs, mut command_line: clap::Command) -> anyhow::Result<Outcome> {
    let mut script = Vec::new();
    generate(args.shell, &mut command_line, "frontier", &mut script);
    output::bytes(&script)?;
    Ok(Outcome::Done)
}

/// Writes a page for the program and each of its commands.
pub fn man(args: &ManArgs, command_line: clap::Command) -> anyhow::Result<Outcome> {
    let folder = &args.folder;
    anyhow::ensure!(folder.is_dir(), "{} is not a folder: must exist", folder.display());
    clap_mangen::generate_to(command_line, folder)
        .with_context(|| format!("cannot write pages to {}", folder.display()))?;
    Ok(Outcome::Done)
}
