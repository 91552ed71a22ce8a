//! What the node uses of the machine: shown in `/diagnostics`, and a trouble when it is too much.

use crate::io::{ProcessUse, ProcessUseError};

/// More of the descriptors that it may open is too much: a share.
const MOST_DESCRIPTORS: f64 = 0.8;
/// More threads are too many: each connection has one or two.
const MOST_THREADS: u64 = 500;
/// More of the machine's memory is too much: a share.
const MOST_MEMORY: f64 = 0.5;

/// Names and values for `/diagnostics`.
pub fn values(used: &ProcessUse) -> Vec<(&'static str, String)> {
    vec![
        ("open descriptors", used.descriptors.to_string()),
        ("threads", used.threads.to_string()),
        ("memory [MB]", format!("{:.1}", used.memory_mb)),
    ]
}

/// What is too much, in one sentence; `None` where nothing is or where nobody tells.
pub fn complaint(used: &Result<ProcessUse, ProcessUseError>) -> Option<String> {
    let too_much = match used {
        Ok(used) => too_much(used),
        Err(full @ ProcessUseError::NoDescriptorLeft) => vec![full.to_string()],
        Err(ProcessUseError::Untold) => Vec::new(),
    };
    let all = too_much.join(", ");
    (!all.is_empty()).then(|| format!("the node runs short: {all}; restart it with ~resume_from before it fails"))
}

fn too_much(used: &ProcessUse) -> Vec<String> {
    let mut found = Vec::new();
    let most = |limit: &u64| MOST_DESCRIPTORS * *limit as f64;
    if let Some(limit) = used.descriptor_limit.filter(|limit| used.descriptors as f64 > most(limit)) {
        found.push(format!("{} of {limit} descriptors are open (ulimit -n)", used.descriptors));
    }
    if used.threads > MOST_THREADS {
        found.push(format!("{} threads run: must be at most {MOST_THREADS}", used.threads));
    }
    if used.memory_mb > MOST_MEMORY * used.machine_mb {
        found.push(format!("it holds {:.0} of the machine's {:.0} MB of memory", used.memory_mb, used.machine_mb));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_too_much_is_named() {
        let little = ProcessUse {
            descriptors: 80,
            descriptor_limit: Some(100),
            threads: 500,
            memory_mb: 1000.0,
            machine_mb: 2000.0,
        };
        let check_told = |used: Result<ProcessUse, ProcessUseError>, expected: &[&str]| {
            let said = complaint(&used);
            assert_eq!(said.is_some(), !expected.is_empty(), "{said:?}");
            assert!(expected.iter().all(|part| said.as_ref().is_some_and(|said| said.contains(part))), "{said:?}");
        };
        let check = |used, expected: &[&str]| check_told(Ok(used), expected);
        check(little, &[]);
        check(ProcessUse { descriptors: 81, ..little }, &["81 of 100 descriptors"]);
        check(ProcessUse { descriptors: 81, descriptor_limit: None, ..little }, &[]);
        let (threads, memory_mb) = (501, 1001.0);
        check(ProcessUse { threads, memory_mb, ..little }, &["501 threads", "1001 of the machine's 2000 MB"]);
        check_told(Err(ProcessUseError::NoDescriptorLeft), &["no descriptor is left"]);
        check_told(Err(ProcessUseError::Untold), &[]);
    }

    #[test]
    fn values_are_told_by_name() {
        let used =
            ProcessUse { descriptors: 7, descriptor_limit: None, threads: 3, memory_mb: 20.04, machine_mb: 2000.0 };
        let told = values(&used);
        assert_eq!(told.iter().map(|(_, value)| value.as_str()).collect::<Vec<_>>(), ["7", "3", "20.0"]);
    }
}
