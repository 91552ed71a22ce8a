//! Where the runs of a world begin.

use crate::geometry::Pose;
use crate::grid::{Cell, Neighbourhood};
use crate::run::NamedWorld;
use crate::sim::World;
use std::collections::{BTreeMap, VecDeque};

/// Starts of the worlds in `maps/`.
const KNOWN: &str = include_str!("../../../configs/worlds.yaml");

/// Room around a start that is chosen automatically, metres.
const CLEARANCE_M: f64 = 0.4;

/// Why there are no starts.
#[derive(Debug, thiserror::Error)]
pub enum StartsError {
    /// The text is another table.
    #[error("the first line must be map,x_m,y_m")]
    Head,
    /// A line that is no start.
    #[error("line {number}: {line:?} must be a map's name and two numbers of metres")]
    Line {
        /// Which, from 1.
        number: usize,
        /// What it says.
        line: String,
    },
    /// A world without so many open spots.
    #[error("there is room for {0} starts: auto must be at most that")]
    NoRoom(usize),
    /// The starts of the built-in worlds cannot be read.
    #[error("configs/worlds.yaml: {0}")]
    Known(String),
}

/// The starts of all worlds that are known by name, and what is done for others. By default
/// those of `configs/worlds.yaml`, and in other worlds the most open spot.
#[derive(Debug, Default)]
pub struct Starts {
    listed: BTreeMap<String, Vec<Pose>>,
    auto: Option<usize>,
}

impl Starts {
    /// So many open spots in each world.
    #[must_use]
    pub fn auto(count: usize) -> Self {
        Self { auto: Some(count), ..Self::default() }
    }

    /// Those of a table with the columns map, x in metres, y in metres, under the head
    /// `map,x_m,y_m`; the default ones for worlds that it does not name.
    ///
    /// # Errors
    /// [`StartsError`] with the line that is wrong.
    pub fn from_csv(text: &str) -> Result<Self, StartsError> {
        Ok(Self { listed: listed(text)?, auto: None })
    }

    /// The starts in a world, metres and radians of its frame.
    pub(super) fn of(&self, world: &NamedWorld) -> Result<Vec<Pose>, StartsError> {
        if let Some(count) = self.auto {
            return spread(&world.world, count);
        }
        if let Some(starts) = self.listed.get(&world.name) {
            return Ok(starts.clone());
        }
        let known: BTreeMap<String, Vec<[f64; 2]>> =
            serde_saphyr::from_str(KNOWN).map_err(|error| StartsError::Known(error.to_string()))?;
        Ok(match known.get(&world.name) {
            Some(starts) => starts.iter().map(|&[x, y]| Pose::new(x, y, 0.0)).collect(),
            None => vec![world.world.most_open_spot()],
        })
    }
}

/// Reads lines of map, x and y under a head.
fn listed(text: &str) -> Result<BTreeMap<String, Vec<Pose>>, StartsError> {
    let mut lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    match lines.next() {
        Some((_, head)) if head.split(',').map(str::trim).eq(["map", "x_m", "y_m"]) => {}
        _ => return Err(StartsError::Head),
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
            None => return Err(StartsError::Line { number: number + 1, line: line.to_owned() }),
        }
    }
    Ok(starts)
}

/// Spots with room that can be reached from the most open one, which is the first; each
/// further one is as far to drive from all before it as can be.
fn spread(world: &World, count: usize) -> Result<Vec<Pose>, StartsError> {
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
            _ => return Err(StartsError::NoRoom(spots.len())),
        }
    }
    Ok(spots.into_iter().map(center).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::{OccupancyGrid, Thresholds};

    #[test]
    fn lines_are_read_by_name() {
        let starts = listed("map,x_m,y_m\na,1,2\nb, 3.5, -4\na,5,6\n").unwrap();
        assert_eq!(starts["a"], [Pose::new(1.0, 2.0, 0.0), Pose::new(5.0, 6.0, 0.0)]);
        assert_eq!(starts["b"], [Pose::new(3.5, -4.0, 0.0)]);
        let error = |text: &str| listed(text).unwrap_err().to_string();
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
