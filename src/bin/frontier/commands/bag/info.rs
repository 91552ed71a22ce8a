//! `frontier bag info`: what a bag holds, and what can be done with it.

use crate::exit::Outcome;
use crate::{bags, output};
use comfy_table::{CellAlignment, Table};
use frontier_explorer::bag::{FrameLink, Summary, TopicSummary, seconds};
use frontier_explorer::replay::{Clock, Inputs, Verdict, Wanted};
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

/// Arguments of `frontier bag info`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The bag.
    bag: PathBuf,
    /// The topic of the map, instead of the one that is guessed.
    #[arg(long, value_name = "TOPIC")]
    map_topic: Option<String>,
    /// The robot's frame, instead of the one that is guessed.
    #[arg(long, value_name = "FRAME")]
    pose_frame: Option<String>,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

/// What `--json` prints.
#[derive(Serialize)]
struct Info<'a> {
    bytes: u64,
    is_indexed: bool,
    start_s: f64,
    end_s: f64,
    duration_s: f64,
    messages: u64,
    compression: Vec<Compressed>,
    topics: &'a [TopicSummary],
    tf: &'a BTreeMap<String, FrameLink>,
    inputs: &'a Inputs,
    verdict: Vec<String>,
    problems: &'a [String],
    notes: Vec<String>,
}

#[derive(Serialize)]
struct Compressed {
    kind: &'static str,
    chunks: u64,
    bytes: u64,
    expanded_bytes: u64,
}

/// Runs `frontier bag info`.
pub fn run(args: &Args) -> anyhow::Result<Outcome> {
    let summary = bags::summary(&args.bag)?;
    let wanted = Wanted { map_topic: args.map_topic.clone(), pose_frame: args.pose_frame.clone(), ..Wanted::default() };
    let inputs = Inputs::of(&summary, &wanted)?;
    if args.json {
        output::json(&info(&summary, &inputs))?;
    } else {
        print(&summary, &inputs)?;
    }
    Ok(Outcome::Done)
}

fn info<'a>(summary: &'a Summary, inputs: &'a Inputs) -> Info<'a> {
    Info {
        bytes: summary.bytes,
        is_indexed: summary.is_indexed,
        start_s: seconds(summary.start),
        end_s: seconds(summary.end),
        duration_s: summary.duration_s(),
        messages: summary.messages,
        compression: compressed(summary).collect(),
        topics: &summary.topics,
        tf: &summary.tf,
        inputs,
        verdict: Verdict::of(summary, inputs).sentences(),
        problems: &summary.problems,
        notes: summary.notes.iter().cloned().chain(Clock::of(summary, inputs).notes()).collect(),
    }
}

fn compressed(summary: &Summary) -> impl Iterator<Item = Compressed> + '_ {
    summary.compression.iter().map(|(kind, &(chunks, bytes, expanded_bytes))| Compressed {
        kind: kind.name(),
        chunks,
        bytes,
        expanded_bytes,
    })
}

fn print(summary: &Summary, inputs: &Inputs) -> anyhow::Result<()> {
    let kinds: Vec<String> = compressed(summary).map(|c| format!("{} chunks {}", c.chunks, c.kind)).collect();
    let when = if summary.messages > 0 {
        format!("{:.1} s from {:.3} s", summary.duration_s(), seconds(summary.start))
    } else {
        "empty".to_owned()
    };
    output::line(format_args!(
        "{when}, {} messages, {:.1} MB, {}",
        summary.messages,
        summary.bytes as f64 / 1e6,
        if kinds.is_empty() { "no chunks".to_owned() } else { kinds.join(", ") },
    ))?;
    bags::warn(summary, inputs)?;
    for topic in &summary.topics {
        if let Some(fault) = &topic.first_fault {
            let (malformed, name) = (topic.malformed, &topic.topic);
            output::line(format_args!("warning: {malformed} messages on {name} are malformed; the first: {fault}"))?;
        }
    }
    output::line(format_args!("\n{}", topics(summary)))?;
    output::line(format_args!("\nframes\n{}", tree(&summary.tf)))?;
    let guess = |value: &Option<String>| value.clone().unwrap_or_else(|| "none".to_owned());
    output::line(format_args!(
        "inputs: map {}, updates {}, scan {}, goals {}, map frame {}, robot frame {}",
        guess(&inputs.map_topic),
        guess(&inputs.updates_topic),
        guess(&inputs.scan_topic),
        guess(&inputs.goal_topic),
        guess(&inputs.map_frame),
        guess(&inputs.base_frame),
    ))?;
    for sentence in Verdict::of(summary, inputs).sentences() {
        output::line(format_args!("{sentence}"))?;
    }
    Ok(())
}

/// A row for each topic; `*` marks the types that are read.
fn topics(summary: &Summary) -> Table {
    let mut table = Table::new();
    table.load_style(comfy_table::presets::NOTHING);
    table.set_header(["topic", "type", "messages", "Hz", "longest gap (s)", "at (s)", "frames"]);
    for column in table.column_iter_mut().skip(2).take(4) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    for topic in &summary.topics {
        let mark = if topic.is_read { "*" } else { "" };
        let shown = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |value| format!("{value:.2}"));
        let frames: Vec<&str> = topic.frames.iter().map(String::as_str).collect();
        let damaged = if topic.malformed > 0 { format!(" ({} malformed)", topic.malformed) } else { String::new() };
        table.add_row([
            format!("{}{mark}", topic.topic),
            topic.kind.clone(),
            format!("{}{damaged}", topic.messages),
            shown(Some(topic.rate_hz).filter(|rate_hz| *rate_hz > 0.0)),
            shown(topic.longest_gap_s),
            shown(topic.longest_gap_at_s.map(|at_s| at_s - seconds(summary.start))),
            frames.join(", "),
        ]);
    }
    table
}

/// The frames, each below its parent.
fn tree(tf: &BTreeMap<String, FrameLink>) -> String {
    let mut children = BTreeMap::<&str, Vec<&str>>::new();
    for (child, link) in tf {
        children.entry(&link.parent).or_default().push(child);
    }
    let roots = children.keys().filter(|name| !tf.contains_key(**name)).copied().collect::<Vec<_>>();
    let mut text = String::new();
    let mut seen = BTreeSet::new();
    let mut stack: Vec<(usize, &str)> = roots.iter().rev().map(|&root| (1, root)).collect();
    while let Some((depth, name)) = stack.pop() {
        if !seen.insert(name) {
            continue;
        }
        let how = match tf.get(name) {
            None => String::new(),
            Some(link) if link.is_static => "  static".to_owned(),
            Some(link) => format!("  {} transforms", link.messages),
        };
        text += &format!("{}{name}{how}\n", "  ".repeat(depth));
        stack.extend(children.get(name).into_iter().flatten().rev().map(|&child| (depth + 1, child)));
    }
    if text.is_empty() { "  none\n".to_owned() } else { text }
}
