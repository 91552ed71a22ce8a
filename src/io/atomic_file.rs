//! A file that is written little by little and appears whole.

use super::destination::{Destination, folder_of, temporary_beside};
use std::fs::File;
use std::io::{self, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// Where the bytes go meanwhile.
enum Inner {
    /// Beside the file that it will replace.
    Beside(NamedTempFile, PathBuf),
    /// Straight into a device or a pipe.
    Through(File),
}

/// A file under way; without [`AtomicFile::commit`] nothing is left of it.
pub struct AtomicFile {
    inner: Inner,
}

impl AtomicFile {
    /// Begins a file that shall be at `path`, whose directory must exist. A symbolic
    /// link is followed; a device or a pipe is written to at once, as it must stay what it
    /// is. New files get the permissions that the umask leaves.
    ///
    /// # Errors
    /// The first error of the file system.
    pub fn create(path: &Path) -> io::Result<Self> {
        let inner = match Destination::of(path)? {
            Destination::Replace(target) => Inner::Beside(temporary_beside(&target)?, target),
            Destination::Through(target) => Inner::Through(Destination::open(&target)?),
        };
        Ok(Self { inner })
    }

    /// Puts the file in its place.
    ///
    /// # Errors
    /// The first error of the file system.
    pub fn commit(self) -> io::Result<()> {
        match self.inner {
            Inner::Beside(file, target) => {
                file.as_file().sync_all()?;
                file.persist(&target).map_err(|error| error.error)?;
                // The new name must reach the disk too; a file system that cannot open or
                // sync a directory has done all it can.
                if let Ok(directory) = File::open(folder_of(&target)) {
                    let _ = directory.sync_all();
                }
                Ok(())
            }
            Inner::Through(mut file) => file.flush(),
        }
    }

    fn file(&mut self) -> &mut File {
        match &mut self.inner {
            Inner::Beside(file, _) => file.as_file_mut(),
            Inner::Through(file) => file,
        }
    }
}

impl Write for AtomicFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file().flush()
    }
}

impl Seek for AtomicFile {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.file().seek(to)
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::os::unix::fs::{FileTypeExt, symlink};

    #[test]
    fn links_and_devices_stay_what_they_are() {
        let dir = tempfile::tempdir().unwrap();
        let (real, link) = (dir.path().join("real"), dir.path().join("link"));
        symlink(&real, &link).unwrap();
        let mut file = AtomicFile::create(&link).unwrap();
        file.write_all(b"whole").unwrap();
        assert!(!real.exists());
        file.commit().unwrap();
        assert_eq!(std::fs::read(&real).unwrap(), b"whole");
        assert!(std::fs::symlink_metadata(&link).unwrap().is_symlink());

        let null = Path::new("/dev/null");
        assert_eq!(Destination::of(null).unwrap(), Destination::Through(null.to_owned()));
        let mut file = AtomicFile::create(null).unwrap();
        file.write_all(b"gone").unwrap();
        file.commit().unwrap();
        assert!(std::fs::symlink_metadata(null).unwrap().file_type().is_char_device());
    }
}
