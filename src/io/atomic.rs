//! Writing a file whole or not at all.
//!
//! A reader that looks at any moment, or after a power cut, finds the old contents or
//! the new, never a part: the bytes go to a temporary file in the same directory,
//! reach the disk, and take the name in one step.

use super::atomic_file::AtomicFile;
use super::destination::{Destination, folder_of, temporary_beside, temporary_prefix};
use std::io::{self, Write};
use std::path::Path;

/// Replaces the contents of `path`, or creates it, as [`AtomicFile`] does.
///
/// # Errors
/// The first error of the file system; the old contents of a file then still stand and
/// the temporary file is gone.
pub fn write_atomic(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = AtomicFile::create(path)?;
    file.write_all(bytes)?;
    file.commit()
}

/// Removes what processes that were killed left behind as they wrote this file; returns how many
/// files those were. Nobody else may be writing it at the same time.
pub fn clear_stale(path: &Path) -> usize {
    let prefix = temporary_prefix(path);
    let Ok(entries) = std::fs::read_dir(folder_of(path)) else { return 0 };
    let is_stale = |entry: &std::fs::DirEntry| entry.file_name().to_string_lossy().starts_with(&prefix);
    entries.flatten().filter(is_stale).filter(|entry| std::fs::remove_file(entry.path()).is_ok()).count()
}

/// Makes a folder, and those above it, unless it is there.
///
/// # Errors
/// What the file system says against it.
pub fn create_folder(path: &Path) -> io::Result<()> {
    std::fs::create_dir_all(path)
}

/// Whether `path` could be written now: its folder takes a file, or what stands there is
/// a device or a pipe. Nothing is left behind and nothing is changed.
///
/// # Errors
/// What the file system says against it.
pub fn check_writable(path: &Path) -> io::Result<()> {
    match Destination::of(path)? {
        Destination::Replace(target) if target.is_dir() => Err(io::ErrorKind::IsADirectory.into()),
        Destination::Replace(target) => temporary_beside(&target).map(drop),
        Destination::Through(_) => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn contents_are_replaced_and_nothing_is_left_over() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a.txt");
        write_atomic(&path, b"one").unwrap();
        write_atomic(&path, b"two").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"two");
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 1);
    }

    #[test]
    fn what_a_killed_process_left_is_cleared_and_nothing_else() {
        let dir = tempfile::tempdir().unwrap();
        for name in [".writing-a.txt-Xy12", ".writing-ab.txt-Xy12", "a.txt"] {
            fs::write(dir.path().join(name), "x").unwrap();
        }
        assert_eq!(clear_stale(&dir.path().join("a.txt")), 1);
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 2);
        assert_eq!(fs::read_to_string(dir.path().join("a.txt")).unwrap(), "x");
    }

    #[test]
    fn a_failure_leaves_no_temporary_file() {
        let dir = tempfile::tempdir().unwrap();
        let taken = dir.path().join("taken");
        fs::create_dir(&taken).unwrap();
        assert!(write_atomic(&taken, b"x").is_err());
        assert!(write_atomic(&dir.path().join("nowhere/a.txt"), b"x").is_err());
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 1);
    }

    #[cfg(unix)]
    #[test]
    fn links_are_followed_and_others_may_read() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let dir = tempfile::tempdir().unwrap();
        let (real, link) = (dir.path().join("real"), dir.path().join("link"));
        write_atomic(&real, b"one").unwrap();
        symlink(&real, &link).unwrap();
        write_atomic(&link, b"two").unwrap();
        assert_eq!(fs::read(&real).unwrap(), b"two");
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        let plain = dir.path().join("plain");
        fs::write(&plain, b"x").unwrap();
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o777;
        assert_eq!(mode(&real), mode(&plain));
    }

    #[cfg(unix)]
    #[test]
    fn a_link_to_a_file_that_is_to_come_stays_a_link() {
        let dir = tempfile::tempdir().unwrap();
        let link = dir.path().join("link");
        std::os::unix::fs::symlink("to_come", &link).unwrap();
        write_atomic(&link, b"one").unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read(dir.path().join("to_come")).unwrap(), b"one");
    }

    #[cfg(unix)]
    #[test]
    fn a_pipe_is_written_to_and_stays_a_pipe() {
        use std::os::unix::fs::FileTypeExt;
        let dir = tempfile::tempdir().unwrap();
        let pipe = dir.path().join("pipe");
        assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        let reader = {
            let pipe = pipe.clone();
            std::thread::spawn(move || fs::read(pipe).unwrap())
        };
        write_atomic(&pipe, b"through").unwrap();
        assert_eq!(reader.join().unwrap(), b"through");
        assert!(fs::symlink_metadata(&pipe).unwrap().file_type().is_fifo());
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 1);
    }

    #[cfg(unix)]
    #[test]
    fn a_device_takes_the_bytes_and_stays_a_device() {
        use std::os::unix::fs::FileTypeExt;
        let null = Path::new("/dev/null");
        // Asked before it is tried: root could replace it.
        assert_eq!(Destination::of(null).unwrap(), Destination::Through(null.to_owned()));
        write_atomic(null, b"gone").unwrap();
        assert!(fs::symlink_metadata(null).unwrap().file_type().is_char_device());
        assert!(write_atomic(Path::new("/dev/full"), b"no room").is_err());
    }

    #[test]
    fn what_cannot_be_written_is_known_before() {
        let dir = tempfile::tempdir().unwrap();
        assert!(check_writable(&dir.path().join("a.txt")).is_ok());
        assert!(check_writable(&dir.path().join("nowhere/a.txt")).is_err());
        assert!(check_writable(dir.path()).is_err());
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 0);
    }
}
