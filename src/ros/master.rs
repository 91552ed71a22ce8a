//! Is there a master? Asked with a time limit, before rosrust is let near it: each of
//! its own failed attempts leaks threads, and a silent master blocks it.

use std::io::{Read, Write};
use std::net::{TcpStream, ToSocketAddrs};
use std::time::Duration;

/// How long each step of the question may take.
const PATIENCE: Duration = Duration::from_secs(2);
/// More of an answer than a master gives is not read.
const MAX_ANSWER_BYTES: u64 = 4096;

/// Why there is no master to speak of.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MasterError {
    /// The address is none.
    #[error("ROS_MASTER_URI is {0:?}: must look like http://host:11311")]
    Uri(String),
    /// Nobody answers there.
    #[error("no ROS master answers at {uri}: {why}")]
    Silent {
        /// Where it was looked for.
        uri: String,
        /// What happened instead.
        why: String,
    },
}

/// Asks the master at an address for its process id (XML-RPC `getPid`).
///
/// # Errors
/// [`MasterError`] with the address and what happened.
pub fn probe(uri: &str) -> Result<(), MasterError> {
    let wrong = || MasterError::Uri(uri.to_owned());
    let address = uri.strip_prefix("http://").ok_or_else(wrong)?.trim_end_matches('/');
    let (host, port) = address.rsplit_once(':').ok_or_else(wrong)?;
    let port: u16 = port.parse().map_err(|_| MasterError::Uri(uri.to_owned()))?;
    let silent = |why: String| MasterError::Silent { uri: uri.to_owned(), why };
    let answer = ask(host.trim_matches(['[', ']']), port).map_err(|e| silent(e.to_string()))?;
    if answer.contains("methodResponse") { Ok(()) } else { Err(silent("what answers there is no master".to_owned())) }
}

fn ask(host: &str, port: u16) -> std::io::Result<String> {
    let mut last = std::io::Error::from(std::io::ErrorKind::NotFound);
    for address in (host, port).to_socket_addrs()? {
        match TcpStream::connect_timeout(&address, PATIENCE) {
            Ok(stream) => return converse(stream, host),
            Err(error) => last = error,
        }
    }
    Err(last)
}

fn converse(mut stream: TcpStream, host: &str) -> std::io::Result<String> {
    stream.set_read_timeout(Some(PATIENCE))?;
    stream.set_write_timeout(Some(PATIENCE))?;
    let body = "<?xml version=\"1.0\"?><methodCall><methodName>getPid</methodName><params><param><value>\
                <string>/frontier_explorer</string></value></param></params></methodCall>";
    let request = format!(
        "POST /RPC2 HTTP/1.1\r\nHost: {host}\r\nContent-Type: text/xml\r\nContent-Length: {}\r\nConnection: close\r\n\r\n{body}",
        body.len()
    );
    stream.write_all(request.as_bytes())?;
    let mut answer = Vec::new();
    let mut limited = stream.take(MAX_ANSWER_BYTES);
    let mut part = [0; 1024];
    // A master may keep the connection open: the closing tag ends the answer too.
    while !contains(&answer, b"</methodResponse>") {
        match limited.read(&mut part)? {
            0 => break,
            n => answer.extend_from_slice(part.get(..n).unwrap_or_default()),
        }
    }
    Ok(String::from_utf8_lossy(&answer).into_owned())
}

fn contains(text: &[u8], word: &[u8]) -> bool {
    text.windows(word.len()).any(|window| window == word)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::net::TcpListener;

    #[test]
    fn addresses_that_are_none_are_named() {
        let error = probe("localhost").unwrap_err().to_string();
        assert_eq!(error, "ROS_MASTER_URI is \"localhost\": must look like http://host:11311");
        for wrong in ["http://localhost:port", "localhost:11311", "https://localhost:11311"] {
            assert!(matches!(probe(wrong), Err(MasterError::Uri(_))), "{wrong}");
        }
    }

    #[test]
    fn silence_and_strangers_are_no_master() {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let uri = format!("http://{}", listener.local_addr().unwrap());
        let stranger = std::thread::spawn(move || {
            let (mut stream, _) = listener.accept().unwrap();
            let mut request = [0; 64];
            assert!(stream.read(&mut request).unwrap() > 0);
            stream.write_all(b"HTTP/1.1 404 Not Found\r\n\r\n").unwrap();
        });
        assert!(matches!(probe(&uri), Err(MasterError::Silent { .. })));
        stranger.join().unwrap();
        assert!(matches!(probe(&uri), Err(MasterError::Silent { .. })));
    }
}
