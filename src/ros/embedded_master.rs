//! A ROS master inside this process, for those who have no ROS: the crate
//! `ros-core-rs` behind a thread of its own.

use super::master::probe;
use std::net::{Ipv4Addr, SocketAddr, TcpListener};
use std::time::{Duration, Instant};

/// How long it may take to begin.
const BEGIN_WITHIN: Duration = Duration::from_secs(5);

/// Why there is no master.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum EmbeddedMasterError {
    /// Somebody else listens there.
    #[error("port {port} is taken: a ROS master may run there already; choose another with --port")]
    PortTaken {
        /// The port.
        port: u16,
    },
    /// It did not begin.
    #[error("the embedded ROS master did not begin at port {port}: {why}")]
    Begin {
        /// The port.
        port: u16,
        /// What happened.
        why: String,
    },
}

/// Starts a master on a port of this machine, or on any free one for port 0; it lives
/// as long as the process. Returns its address, as `ROS_MASTER_URI` has it.
///
/// # Errors
/// [`EmbeddedMasterError`] with the port.
pub fn start_embedded_master(port: u16) -> Result<String, EmbeddedMasterError> {
    // Taken for a moment, to see that it is free and which one it is.
    let listener =
        TcpListener::bind((Ipv4Addr::LOCALHOST, port)).map_err(|_| EmbeddedMasterError::PortTaken { port })?;
    let port = listener.local_addr().map_or(port, |address| address.port());
    drop(listener);
    let failed = |why: String| EmbeddedMasterError::Begin { port, why };
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build();
    let runtime = runtime.map_err(|e| failed(e.to_string()))?;
    std::thread::spawn(move || {
        let address = SocketAddr::from((Ipv4Addr::LOCALHOST, port));
        let master = ros_core_rs::core::Master::new(&address);
        // It serves until the process ends; whoever waits for it sees that it failed.
        let _ = runtime.block_on(master.serve());
    });
    let uri = format!("http://localhost:{port}");
    let began = Instant::now();
    loop {
        match probe(&uri) {
            Ok(()) => return Ok(uri),
            Err(error) if began.elapsed() > BEGIN_WITHIN => return Err(failed(error.to_string())),
            Err(_) => std::thread::sleep(Duration::from_millis(20)),
        }
    }
}
