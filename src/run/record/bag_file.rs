//! A bag that appears whole when it is finished. What fails on the way is told then.

use super::RecordError;
use crate::bag::{BagWriter, Compression, Connection, MessageType, Nanos};
use crate::io::AtomicFile;
use std::io;
use std::path::{Path, PathBuf};

/// A bag while it is written.
pub(super) struct BagFile {
    path: PathBuf,
    writer: Option<BagWriter<AtomicFile>>,
    failed: Option<io::Error>,
}

impl BagFile {
    /// Begins one.
    pub fn create(path: &Path) -> Result<Self, RecordError> {
        let begin = || BagWriter::new(AtomicFile::create(path)?, Compression::Lz4);
        let writer = begin().map_err(RecordError::write(path))?;
        Ok(Self { path: path.to_owned(), writer: Some(writer), failed: None })
    }

    /// A topic of our own.
    pub fn topic(&mut self, name: &str, kind: MessageType, is_latching: bool) -> u32 {
        self.writer.as_mut().map_or(0, |writer| writer.topic(name, kind, is_latching))
    }

    /// A topic of another bag.
    pub fn connect(&mut self, connection: Connection) -> u32 {
        self.writer.as_mut().map_or(0, |writer| writer.connect(connection))
    }

    /// Adds a message; the first failure is remembered.
    pub fn put(&mut self, number: u32, time: Nanos, data: &[u8]) {
        if let Some(writer) = &mut self.writer
            && let Err(error) = writer.write(number, time, data)
        {
            self.failed.get_or_insert(error);
        }
    }

    /// Closes it.
    pub fn finish(&mut self) -> Result<(), RecordError> {
        let outcome = match (self.failed.take(), self.writer.take()) {
            (Some(error), _) => Err(error),
            (None, Some(writer)) => writer.finish().and_then(AtomicFile::commit),
            (None, None) => Ok(()),
        };
        outcome.map_err(RecordError::write(&self.path))
    }
}
