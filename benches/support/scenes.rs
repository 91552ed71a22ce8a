//! Maps of any size to measure on, the same at every run.

use frontier_explorer::geometry::{Point, Pose};
use frontier_explorer::grid::{Cell, GridInfo, OccupancyGrid};

/// Edge length of a cell.
const RESOLUTION_M: f64 = 0.05;

/// A map and where the robot is.
pub struct Scene {
    /// What it shows.
    pub name: &'static str,
    /// The map.
    pub grid: OccupancyGrid,
    /// The robot.
    pub robot: Pose,
}

/// Numbers without an end that are the same at every run: Knuth's generator of MMIX.
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, end: u32) -> u32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) as u32) % end
    }
}

fn empty_grid(size: u32, value: i8) -> OccupancyGrid {
    let info = GridInfo::new(size, size, RESOLUTION_M, Pose::default());
    OccupancyGrid::filled(info.unwrap_or_else(|error| panic!("{size}: {error}")), value)
}

fn centre(grid: &OccupancyGrid) -> Cell {
    Cell::new(grid.info().width() as i32 / 2, grid.info().height() as i32 / 2)
}

/// The scene with the robot at a cell that is made free.
fn scene(name: &'static str, mut grid: OccupancyGrid, robot: Cell) -> Scene {
    grid.set(robot, OccupancyGrid::FREE);
    let Point { coords } = grid.info().center(robot);
    Scene { name, grid, robot: Pose::new(coords.x, coords.y, 0.0) }
}

/// Known and free, but for a band of unknown along its edges.
pub fn empty(size: u32) -> Scene {
    let mut grid = empty_grid(size, OccupancyGrid::FREE);
    let edge = 20.min(size as i32 / 4);
    for index in 0..grid.info().len() {
        let Cell { x, y } = grid.info().cell(index);
        if x.min(y) < edge || x.max(y) >= size as i32 - edge {
            grid.data_mut()[index] = OccupancyGrid::UNKNOWN;
        }
    }
    let robot = centre(&grid);
    scene("empty", grid, robot)
}

/// Every cell free, unknown or occupied on its own: `free_percent` of them free, half of
/// the others unknown. Above 60 percent most free cells are connected; below, the robot
/// is shut in.
pub fn salt_and_pepper(name: &'static str, size: u32, free_percent: u32) -> Scene {
    let mut numbers = Numbers(7);
    let mut grid = empty_grid(size, OccupancyGrid::FREE);
    for value in grid.data_mut() {
        let percent = numbers.below(100);
        if percent >= free_percent {
            *value = if percent.is_multiple_of(2) { OccupancyGrid::UNKNOWN } else { OccupancyGrid::OCCUPIED };
        }
    }
    let robot = centre(&grid);
    scene(name, grid, robot)
}

/// One way as wide as a cell, up and down between walls as thick as a cell; unknown below and
/// above it.
pub fn maze(size: u32) -> Scene {
    let mut grid = empty_grid(size, OccupancyGrid::FREE);
    let last = size as i32 - 1;
    for index in 0..grid.info().len() {
        let Cell { x, y } = grid.info().cell(index);
        let gap = if x % 4 == 1 { 1 } else { last - 1 };
        if y == 0 || y == last {
            grid.data_mut()[index] = OccupancyGrid::UNKNOWN;
        } else if x % 2 == 1 && y != gap {
            grid.data_mut()[index] = OccupancyGrid::OCCUPIED;
        }
    }
    let robot = centre(&grid);
    scene("maze", grid, robot)
}

/// A floor beside itself again and again, with ways from one to the next and three
/// patches of unknown on each.
pub fn tiled(name: &'static str, floor: &OccupancyGrid, size: u32) -> Scene {
    let (width, height) = (floor.info().width() as i32, floor.info().height() as i32);
    let mut grid = empty_grid(size, OccupancyGrid::UNKNOWN);
    for index in 0..grid.info().len() {
        let Cell { x, y } = grid.info().cell(index);
        let value = floor.get(Cell::new(x % width, y % height));
        grid.data_mut()[index] = value.unwrap_or(OccupancyGrid::UNKNOWN);
    }
    let mut numbers = Numbers(11);
    for row in 0..=size as i32 / height {
        for column in 0..=size as i32 / width {
            let corner = Cell::new(column * width, row * height);
            // Through the seams, as wide as the office's corridor.
            disc(&mut grid, corner.offset((0, height / 2)), 18, OccupancyGrid::FREE);
            disc(&mut grid, corner.offset((width * 63 / 100, 0)), 18, OccupancyGrid::FREE);
            for _ in 0..3 {
                let at = (numbers.below(width as u32) as i32, numbers.below(height as u32) as i32);
                disc(&mut grid, corner.offset(at), 25, OccupancyGrid::UNKNOWN);
            }
        }
    }
    let robot = Cell::new(size as i32 / 2 / width * width, size as i32 / 2 / height * height + height / 2);
    disc(&mut grid, robot, 18, OccupancyGrid::FREE);
    scene(name, grid, robot)
}

/// A tiled scene with the robot at a place of the floor, in the tile in the middle.
#[allow(dead_code)] // not every user asks for a place
pub fn standing(mut scene: Scene, floor: &OccupancyGrid, at: Point) -> Scene {
    let (width, height) = (floor.info().width() as i32, floor.info().height() as i32);
    let size = scene.grid.info().width() as i32;
    let in_floor = floor.info().cell_at(at);
    let tile = |length: i32, place: i32| (size / 2 / length * length + place).min(size - 1);
    let robot = Cell::new(tile(width, in_floor.x), tile(height, in_floor.y));
    let Point { coords } = scene.grid.info().center(robot);
    scene.robot = Pose::new(coords.x, coords.y, 0.0);
    scene
}

/// Fills a disc; cells beyond the grid are left out.
pub fn disc(grid: &mut OccupancyGrid, centre: Cell, radius: i32, value: i8) {
    for dy in -radius..=radius {
        for dx in -radius..=radius {
            if dx * dx + dy * dy <= radius * radius {
                grid.set(centre.offset((dx, dy)), value);
            }
        }
    }
}
