//! Chooses the reader for a bag: the `rosbag` crate where it is whole, the scanner otherwise.

use super::indexed::IndexedBag;
use super::layout::Layout;
use super::reader::{BagError, BagReader};
use super::record::MAGIC;
use super::scanner::BagScanner;
use std::io::{Read, Seek};
use std::path::Path;

/// The reader for the bag at `path`, of which `file` is open: the `rosbag` crate where all
/// records from the first to the last are there, and the scanner where the bag is cut,
/// damaged or was never closed. Both give the same messages.
///
/// # Errors
/// [`BagError`] when this is no bag, or one of another format.
pub fn open_bag<R: Read + Seek + 'static>(path: &Path, file: R) -> Result<Box<dyn BagReader>, BagError> {
    let mut scanner = BagScanner::new(file)?;
    let layout = Layout::of(&mut scanner.input)?;
    scanner.seek(MAGIC.len() as u64)?;
    // A file that cannot be mapped into memory can still be read.
    match layout.and_then(|layout| Some((layout, rosbag::RosBag::new(path).ok()?))) {
        Some((layout, bag)) => Ok(Box::new(IndexedBag::new(bag, layout, scanner))),
        None => Ok(Box::new(scanner)),
    }
}
