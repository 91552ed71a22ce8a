//! What every reader of bags can do: the chunks one after the other, or by their places.

use super::connections::Connection;
use super::content::Chunk;
use std::collections::BTreeMap;
use std::io;
use std::sync::Arc;

/// Why a file cannot be read as a bag at all.
#[derive(Debug, thiserror::Error)]
pub enum BagError {
    /// The file system refused.
    #[error("cannot read the bag: {0}")]
    Io(#[from] io::Error),
    /// An old bag.
    #[error("this is a bag of format {0}: must be 2.0 (`rosbag fix old.bag new.bag` turns it into one)")]
    Version(String),
    /// Something else.
    #[error("this is no ROS 1 bag: it must begin with #ROSBAG V2.0")]
    NoBag,
}

/// Reads the chunks of a bag in the order of the file, or by their places.
pub trait BagReader {
    /// The file's length, bytes.
    fn length(&self) -> u64;

    /// Whether the bag was closed properly: its header names an index. A scanner knows when
    /// it has come to that header.
    fn is_indexed(&self) -> bool;

    /// The connections seen so far, by their numbers.
    fn connections(&self) -> &BTreeMap<u32, Arc<Connection>>;

    /// Takes over connections that were read before.
    fn know(&mut self, connections: &BTreeMap<u32, Arc<Connection>>);

    /// What was wrong so far, a sentence each.
    fn problems(&self) -> &[String];

    /// Goes to a chunk by the place of its record in the file, bytes.
    ///
    /// # Errors
    /// When the file cannot be read.
    fn seek(&mut self, offset: u64) -> io::Result<()>;

    /// Reads the next chunk; false at the end, wherever that is.
    ///
    /// # Errors
    /// When the file cannot be read; damage is no error.
    fn next_chunk(&mut self, chunk: &mut Chunk) -> io::Result<bool>;
}
