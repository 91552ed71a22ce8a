//! What this process uses of the machine: descriptors, threads and memory, as Linux tells it
//! below `/proc`.

use std::fs::{read_dir, read_to_string};
use std::io::Error;
use std::path::Path;

/// The errors of a process, and of a machine, that may open nothing more (`EMFILE`, `ENFILE`).
const NOTHING_MORE: [i32; 2] = [24, 23];

/// Why it is not known what a process uses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ProcessUseError {
    /// There is no `/proc` as Linux has it.
    #[error("/proc does not tell what the process uses")]
    Untold,
    /// Not even the files that tell it can be opened.
    #[error("no descriptor is left to open")]
    NoDescriptorLeft,
}

impl From<Error> for ProcessUseError {
    fn from(error: Error) -> Self {
        let is_full = error.raw_os_error().is_some_and(|code| NOTHING_MORE.contains(&code));
        if is_full { Self::NoDescriptorLeft } else { Self::Untold }
    }
}

/// What a process uses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProcessUse {
    /// Open files and sockets.
    pub descriptors: u64,
    /// How many it may open; `None` where there is no limit.
    pub descriptor_limit: Option<u64>,
    /// Threads.
    pub threads: u64,
    /// Resident memory, MB of 1,048,576 bytes.
    pub memory_mb: f64,
    /// Memory of the machine, MB.
    pub machine_mb: f64,
}

impl ProcessUse {
    /// What this process uses now.
    ///
    /// # Errors
    /// [`ProcessUseError`] where `/proc` is absent, and where nothing more can be opened.
    pub fn now() -> Result<Self, ProcessUseError> {
        Self::told_below(Path::new("/proc"))
    }

    fn told_below(proc: &Path) -> Result<Self, ProcessUseError> {
        let own = proc.join("self");
        let status = read_to_string(own.join("status"))?;
        let limits = read_to_string(own.join("limits"))?;
        let machine = read_to_string(proc.join("meminfo"))?;
        // The folder that is read is open, too.
        let descriptors = (read_dir(own.join("fd"))?.count() as u64).saturating_sub(1);
        let number = |text: &str, name: &str| number_after(text, name).ok_or(ProcessUseError::Untold);
        Ok(Self {
            descriptors,
            // "unlimited" is no number.
            descriptor_limit: number_after(&limits, "Max open files"),
            threads: number(&status, "Threads:")?,
            memory_mb: number(&status, "VmRSS:")? as f64 / 1024.0,
            machine_mb: number(&machine, "MemTotal:")? as f64 / 1024.0,
        })
    }
}

/// The number that follows a name at the beginning of a line.
fn number_after(text: &str, name: &str) -> Option<u64> {
    let rest = text.lines().find_map(|line| line.strip_prefix(name))?;
    rest.split_whitespace().next()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs::{File, create_dir_all, write};

    #[test]
    fn what_linux_tells_is_read() {
        let proc = tempfile::tempdir().unwrap();
        let told = || ProcessUse::told_below(proc.path());
        let own = proc.path().join("self");
        assert_eq!(told(), Err(ProcessUseError::Untold));
        create_dir_all(own.join("fd")).unwrap();
        for descriptor in 0..5 {
            File::create(own.join("fd").join(descriptor.to_string())).unwrap();
        }
        write(own.join("status"), "Name:\tx\nVmHWM:\t  9000 kB\nVmRSS:\t    4096 kB\nThreads:\t12\n").unwrap();
        write(proc.path().join("meminfo"), "MemTotal:        2097152 kB\nMemFree:  1 kB\n").unwrap();
        let limits = "Limit   Soft Limit  Hard Limit  Units\nMax open files            1024   4096   files\n";
        write(own.join("limits"), limits).unwrap();
        let mut expected = ProcessUse {
            descriptors: 4,
            descriptor_limit: Some(1024),
            threads: 12,
            memory_mb: 4.0,
            machine_mb: 2048.0,
        };
        assert_eq!(told(), Ok(expected));
        write(own.join("limits"), limits.replace("1024", "unlimited")).unwrap();
        expected.descriptor_limit = None;
        assert_eq!(told(), Ok(expected));
        write(own.join("status"), "Name:\tx\n").unwrap();
        assert_eq!(told(), Err(ProcessUseError::Untold));
    }

    #[test]
    fn a_process_that_may_open_nothing_more_is_told_apart() {
        for (code, expected) in [
            (24, ProcessUseError::NoDescriptorLeft),
            (23, ProcessUseError::NoDescriptorLeft),
            (2, ProcessUseError::Untold),
        ] {
            assert_eq!(ProcessUseError::from(Error::from_raw_os_error(code)), expected, "{code}");
        }
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn this_process_has_more_descriptors_when_it_opens_more() {
        let before = ProcessUse::now().unwrap();
        let files: Vec<File> = (0..100).map(|_| File::open("/proc/self/status").unwrap()).collect();
        let after = ProcessUse::now().unwrap();
        // Other tests open and close some meanwhile.
        assert!(after.descriptors > before.descriptors + 50, "{before:?} {after:?}");
        assert!(after.threads > 0 && after.memory_mb > 1.0 && after.memory_mb < after.machine_mb, "{after:?}");
        drop(files);
    }
}
