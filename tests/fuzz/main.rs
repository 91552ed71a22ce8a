//! Whatever comes from outside, as bytes that are nearly right: nothing panics, hangs or takes
//! memory without bound.
//!
//! Each test is a target: it changes valid inputs, made by code or kept in `corpus/<target>/`, at
//! random for a second, or for the seconds that `FRONTIER_FUZZ_S` says. An input that gets an answer of a new kind is
//! changed further. A failure prints the file that the input lies in; moved to the target's corpus it
//! is tried first in each run from then on. `FRONTIER_FUZZ_SEED` begins elsewhere;
//! `--nocapture` shows how many inputs were tried and taken.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::print_stderr)]

mod bags;
mod engine;
mod exploring;
mod files;
mod maps;
mod messages;
mod mutate;
mod records;
mod settings;
