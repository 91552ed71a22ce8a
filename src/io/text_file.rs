//! Reading small files: a preset, a list, a session. A device that never ends is no such file.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// The longest file that is read, bytes.
const MAX_BYTES: u64 = 1 << 28;

/// Reads a file or a pipe to its end.
///
/// # Errors
/// What the file system says against it; a file that is too long, as a device without an end is.
pub fn read_bytes(path: &Path) -> io::Result<Vec<u8>> {
    read_at_most(path, MAX_BYTES)
}

/// Reads the text of a file or a pipe to its end.
///
/// # Errors
/// As [`read_bytes`], and what is no UTF-8.
pub fn read_text(path: &Path) -> io::Result<String> {
    let is_no_text = |_| io::Error::new(io::ErrorKind::InvalidData, "it holds no text in UTF-8");
    String::from_utf8(read_bytes(path)?).map_err(is_no_text)
}

/// Reads the text of a file, if there is one.
///
/// # Errors
/// As [`read_text`].
pub fn read_if_there(path: &Path) -> io::Result<Option<String>> {
    match read_text(path) {
        Ok(text) => Ok(Some(text)),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(error),
    }
}

fn read_at_most(path: &Path, max_bytes: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    File::open(path)?.take(max_bytes + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > max_bytes {
        let why = format!("it is longer than {max_bytes} bytes, or has no end");
        return Err(io::Error::new(io::ErrorKind::FileTooLarge, why));
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_there_is_read_and_what_is_not_is_none() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a.txt");
        assert_eq!(read_if_there(&path).unwrap(), None);
        std::fs::write(&path, "x").unwrap();
        assert_eq!(read_if_there(&path).unwrap().as_deref(), Some("x"));
        std::fs::write(&path, [0xff]).unwrap();
        assert_eq!(read_text(&path).unwrap_err().to_string(), "it holds no text in UTF-8");
    }

    #[cfg(unix)]
    #[test]
    fn a_device_without_an_end_is_refused() {
        let error = read_at_most(Path::new("/dev/zero"), 1000).unwrap_err();
        assert_eq!(error.to_string(), "it is longer than 1000 bytes, or has no end");
        assert_eq!(read_at_most(Path::new("/dev/null"), 1000).unwrap(), b"");
    }
}
