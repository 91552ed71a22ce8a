//! Where the runs of a world begin.

use anyhow::{Context, bail};
use frontier_explorer::geometry::Pose;
use frontier_explorer::grid::{Cell, Neighbourhood};
use frontier_explorer::sim::World;
use std::collections::{BTreeMap, VecDeque};
use std::path::PathBuf;

/// Starts of the worlds in `maps/`.
const KNOWN: &str = include_str!("../../../../../configs/worlds.yaml");

/// Room around a start that is chosen automatically, metres.
const CLEARANCE_M: f64 = 0.4;

/// What the user asks for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Starts {
    /// This many open spots.
    Auto(usize),
    /// A CSV file.
    File(PathBuf),
}

/// Reads `auto`, `auto:N` or a file name.
pub fn parse(text: &str) -> Result<Starts, String> {
    let Some(count) = text.strip_prefix("auto") else { return Ok(Starts::File(text.into())) };
    match count.trim_start_matches([':', ' ', '=']) {
        "" if count.is_empty() => Ok(Starts::Auto(1)),
        _ if text.ends_with(".csv") => Ok(Starts::File(text.into())),
        number => match number.parse() {
            Ok(number) if number > 0 => Ok(Starts::Auto(number)),
            _ => Err(format!("{text:?}: must be auto:N with N > 0, or a CSV file")),
        },
    }
}

/// The starts of all worlds that are known by name, and what is done for others.
#[derive(Debug, Default)]
pub struct Table {
    listed: BTreeMap<String, Vec<Pose>>,
    auto: Option<usize>,
}

impl Table {
    /// The table that the user asks for.
    pub fn of(starts: &Starts) -> anyhow::Result<Self> {
        match starts {
            Starts::Auto(count) => Ok(Self { auto: Some(*count), ..Self::default() }),
            Starts::File(file) => {
                let text = std::fs::read_to_string(file).with_context(|| format!("cannot read {}", file.display()))?;
                let listed = from_csv(&text).with_context(|| file.display().to_string())?;
                Ok(Self { listed, auto: None })
            }
        }
    }

    /// The starts of a world: those of the user's file; if it has none, those of
    /// `configs/worlds.yaml`; if that has none either, the most open spot.
    pub fn starts(&self, name: &str, world: &World) -> anyhow::Result<Vec<Pose>> {
        if let Some(count) = self.auto {
            return spread(world, count).with_context(|| format!("world {name}"));
        }
        if let Some(starts) = self.listed.get(name) {
            return Ok(starts.clone());
        }
        let known: BTreeMap<String, Vec<[f64; 2]>> = serde_saphyr::from_str(KNOWN).context("configs/worlds.yaml")?;
        Ok(match known.get(name) {
            Some(starts) => starts.iter().map(|&[x, y]| Pose::new(x, y, 0.0)).collect(),
            None => vec![world.most_open_spot()],
        })
    }
}

/// Reads lines of map, x in metres, y in metres under a head.
fn from_csv(text: &str) -> anyhow::Result<BTreeMap<String, Vec<Pose>>> {
    let mut lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    match lines.next() {
        Some((_, head)) if head.split(',').map(str::trim).eq(["map", "x_m", "y_m"]) => {}
        _ => bail!("the first line must be map,x_m,y_m"),
    }
    let mut starts: BTreeMap<String, Vec<Pose>> = BTreeMap::new();
    for (number, line) in lines {
        let fields: Vec<&str> = line.split(',').map(str::trim).collect();
        let pose = match *fields.as_slice() {
            [map, x, y] => x.parse().and_then(|x| y.parse().map(|y| (map, Pose::new(x, y, 0.0)))).ok(),
            _ => None,
        };
        match pose.filter(|(_, pose)| pose.is_finite()) {
            Some((map, pose)) => starts.entry(map.to_owned()).or_default().push(pose),
            None => bail!("line {}: {line:?} must be a map's name and two numbers of metres", number + 1),
        }
    }
    Ok(starts)
}

/// Spots with room that can be reached from the most open one, which is the first; each
/// further one is as far to drive from all before it as can be.
fn spread(world: &World, count: usize) -> anyhow::Result<Vec<Pose>> {
    let info = world.info();
    let center = |cell: Cell| {
        let point = info.center(cell);
        Pose::new(point.x, point.y, 0.0)
    };
    let mut steps: Vec<u32> = vec![u32::MAX; info.len()];
    let mut spots = vec![info.cell_at(world.most_open_spot().position())];
    while let Some(&newest) = spots.last() {
        let mut queue = VecDeque::from([(newest, 0)]);
        while let Some((cell, step)) = queue.pop_front() {
            let Some(best) = info.index(cell).and_then(|index| steps.get_mut(index)) else { continue };
            if *best <= step {
                continue;
            }
            *best = step;
            let around = info.neighbours(cell, Neighbourhood::Four);
            queue.extend(around.filter(|&next| world.disc_fits(next, CLEARANCE_M)).map(|next| (next, step + 1)));
        }
        if spots.len() == count {
            break;
        }
        let farthest = steps.iter().enumerate().filter(|(_, step)| **step < u32::MAX).max_by_key(|(i, step)| {
            // The first of several that are equally far.
            (**step, std::cmp::Reverse(*i))
        });
        match farthest {
            Some((index, &step)) if step > 0 => spots.push(info.cell(index)),
            _ => bail!("there is room for {} starts: auto must be at most that", spots.len()),
        }
    }
    Ok(spots.into_iter().map(center).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use frontier_explorer::grid::{OccupancyGrid, Thresholds};

    #[test]
    fn starts_are_a_file_or_a_number() {
        assert_eq!(parse("auto"), Ok(Starts::Auto(1)));
        assert_eq!(parse("auto:3"), Ok(Starts::Auto(3)));
        assert_eq!(parse("auto 3"), Ok(Starts::Auto(3)));
        assert_eq!(parse("starts.csv"), Ok(Starts::File("starts.csv".into())));
        assert_eq!(parse("automatic.csv"), Ok(Starts::File("automatic.csv".into())));
        assert!(parse("auto:0").is_err() && parse("auto:x").is_err());
    }

    #[test]
    fn lines_are_read_by_name() {
        let starts = from_csv("map,x_m,y_m\na,1,2\nb, 3.5, -4\na,5,6\n").unwrap();
        assert_eq!(starts["a"], [Pose::new(1.0, 2.0, 0.0), Pose::new(5.0, 6.0, 0.0)]);
        assert_eq!(starts["b"], [Pose::new(3.5, -4.0, 0.0)]);
        let error = |text: &str| from_csv(text).unwrap_err().to_string();
        assert_eq!(error("a,1,2\n"), "the first line must be map,x_m,y_m");
        assert!(error("map,x_m,y_m\na,1\n").starts_with("line 2: \"a,1\""));
        assert!(error("map,x_m,y_m\na,1,nan\n").starts_with("line 2"));
    }

    #[test]
    fn automatic_starts_are_far_from_each_other() {
        let truth =
            OccupancyGrid::from_ascii("############\n#..........#\n#..........#\n#..........#\n############").unwrap();
        let world = World::new(&truth, &Thresholds::default()).unwrap();
        let starts = spread(&world, 3).unwrap();
        assert_eq!(starts, spread(&world, 3).unwrap());
        assert_eq!(starts[0], world.most_open_spot());
        // In a room 10 m long the third lies between the first two.
        for (a, b) in [(0, 1), (0, 2), (1, 2)] {
            assert!(starts[a].distance_to(starts[b].position()) > 4.0, "{starts:?}");
        }
        assert_eq!(
            spread(&world, 31).unwrap_err().to_string(),
            "there is room for 30 starts: auto must be at most that"
        );
    }
}
