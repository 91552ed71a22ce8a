//! Calling a service within a time limit: rosrust's own call waits half a minute for a
//! service that is not there, and for ever for one that hangs.

use super::node::{Node, describe};
use rosrust::{Client, ServicePair};
use std::sync::mpsc;
use std::time::Duration;

/// Why a service gave no answer.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CallError {
    /// Nobody offers it.
    #[error("the service {service} is not there")]
    Absent {
        /// Its name.
        service: String,
    },
    /// It takes too long.
    #[error("the service {service} gave no answer for {limit_s} s")]
    Late {
        /// Its name.
        service: String,
        /// How long was waited, seconds.
        limit_s: u64,
    },
    /// It said no, or what it said is no answer.
    #[error("the service {service} failed: {why}")]
    Failed {
        /// Its name.
        service: String,
        /// What it said.
        why: String,
    },
}

/// How long it is looked for.
const PROBE: Duration = Duration::from_secs(1);

/// Calls a service; a call that hangs is left to its thread.
///
/// # Errors
/// [`CallError`] with the service.
pub fn call<T: ServicePair>(
    node: &Node,
    service: &str,
    request: T::Request,
    limit: Duration,
) -> Result<T::Response, CallError> {
    let failed = |why: String| CallError::Failed { service: service.to_owned(), why };
    let client: Client<T> = node.ros().client(service).map_err(|e| failed(describe(&e)))?;
    let (sender, receiver) = mpsc::channel();
    std::thread::spawn(move || {
        let answer = match client.probe(PROBE) {
            Ok(()) => Some(client.req(&request)),
            Err(_) => None,
        };
        // Nobody waits for an answer that comes too late.
        let _ = sender.send(answer);
    });
    match receiver.recv_timeout(limit) {
        Ok(Some(Ok(Ok(response)))) => Ok(response),
        Ok(Some(Ok(Err(why)))) => Err(failed(why)),
        Ok(Some(Err(error))) => Err(failed(error.to_string())),
        Ok(None) => Err(CallError::Absent { service: service.to_owned() }),
        Err(_) => Err(CallError::Late { service: service.to_owned(), limit_s: limit.as_secs() }),
    }
}
