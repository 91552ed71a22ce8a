//! Where the bytes for a name go: into a file that is replaced in one step, or straight
//! into a device, a pipe, or what a symbolic link names.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// The longest chain of symbolic links that is followed, as in Linux.
const MAX_LINKS: usize = 40;

/// What stands at a name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Destination {
    /// A regular file, or nothing yet: this path is replaced.
    Replace(PathBuf),
    /// A device, a pipe or a socket: replacing it would take it away from everybody, so
    /// that it is written to.
    Through(PathBuf),
}

impl Destination {
    /// Follows symbolic links, also to a file that is still to come.
    ///
    /// # Errors
    /// The file system's, for links in a circle and folders that may not be looked into.
    pub fn of(path: &Path) -> io::Result<Self> {
        // What is under /dev and /proc are handles of others, even where they are files:
        // /dev/stdout may be one that the shell holds open.
        if path.starts_with("/dev") || path.starts_with("/proc") {
            return Ok(if path.exists() { Self::Through(path.to_owned()) } else { Self::Replace(path.to_owned()) });
        }
        let mut target = path.to_owned();
        for _ in 0..MAX_LINKS {
            match fs::symlink_metadata(&target) {
                Ok(found) if found.is_symlink() => {
                    let to = fs::read_link(&target)?;
                    target = folder_of(&target).join(to);
                    if target.starts_with("/dev") || target.starts_with("/proc") {
                        return Ok(Self::Through(target));
                    }
                }
                Ok(found) if found.is_file() || found.is_dir() => return Ok(Self::Replace(target)),
                Ok(_) => return Ok(Self::Through(target)),
                Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Self::Replace(target)),
                Err(error) => return Err(error),
            }
        }
        Err(io::Error::other(format!("{} leads through too many symbolic links", path.display())))
    }

    /// Opens a device or a pipe for writing; a pipe waits for its reader.
    pub fn open(path: &Path) -> io::Result<fs::File> {
        fs::OpenOptions::new().write(true).open(path)
    }
}

/// The folder that a file is in.
pub(super) fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

/// A temporary file in the folder of a file that it is to replace, with that file's
/// permissions, or what the umask leaves.
pub(super) fn temporary_beside(target: &Path) -> io::Result<tempfile::NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    let prefix = temporary_prefix(target);
    builder.prefix(&prefix);
    #[cfg(unix)]
    let permissions = {
        use std::os::unix::fs::PermissionsExt;
        fs::metadata(target).map_or_else(|_| fs::Permissions::from_mode(0o666), |old| old.permissions())
    };
    #[cfg(unix)]
    builder.permissions(permissions);
    builder.tempfile_in(folder_of(target))
}

/// How the names of temporary files for a file begin: what a killed process leaves behind can be
/// told from what others are writing.
pub(super) fn temporary_prefix(target: &Path) -> String {
    let name = target.file_name().map_or_else(Default::default, |name| name.to_string_lossy().into_owned());
    format!(".writing-{name}-")
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::os::unix::fs::symlink;

    #[test]
    fn devices_are_never_replaced() {
        for device in ["/dev/null", "/dev/full"] {
            assert_eq!(Destination::of(Path::new(device)).unwrap(), Destination::Through(device.into()));
        }
        let dir = tempfile::tempdir().unwrap();
        let link = dir.path().join("link");
        symlink("/dev/null", &link).unwrap();
        assert_eq!(Destination::of(&link).unwrap(), Destination::Through("/dev/null".into()));
    }

    #[test]
    fn links_lead_to_files_that_are_there_or_to_come() {
        let dir = tempfile::tempdir().unwrap();
        let of = |name: &str| Destination::of(&dir.path().join(name)).unwrap();
        let at = |name: &str| Destination::Replace(dir.path().join(name));
        fs::write(dir.path().join("real"), "x").unwrap();
        for (to, name) in [("real", "link"), ("link", "link_to_link"), ("to_come", "dangling")] {
            symlink(to, dir.path().join(name)).unwrap();
        }
        assert_eq!((of("real"), of("link"), of("link_to_link")), (at("real"), at("real"), at("real")));
        assert_eq!((of("dangling"), of("new")), (at("to_come"), at("new")));
        symlink("round", dir.path().join("round")).unwrap();
        let error = Destination::of(&dir.path().join("round")).unwrap_err().to_string();
        assert!(error.contains("too many symbolic links"), "{error}");
    }
}
