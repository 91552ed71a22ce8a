//! A publisher by hand, whose connections can be cut without its leaving the master.

use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};
use std::sync::{Arc, Mutex};
use std::time::Duration;

/// Publishes `std_msgs/Bool`, ten times a second to each connection, or what it is told to send.
pub struct FakePublisher {
    connections: Arc<Mutex<Vec<TcpStream>>>,
}

impl FakePublisher {
    /// Registers with the master at an address.
    pub fn start(master: &str, topic: &str) -> Self {
        Self::telling(master, topic, vec![1, 0, 0, 0, 1])
    }

    /// The same with these bytes for a message and its length.
    pub fn telling(master: &str, topic: &str, bytes: Vec<u8>) -> Self {
        let slave = TcpListener::bind("127.0.0.1:0").unwrap();
        let data = TcpListener::bind("127.0.0.1:0").unwrap();
        let (uri, port) = (format!("http://{}/", slave.local_addr().unwrap()), data.local_addr().unwrap().port());
        let connections = Arc::<Mutex<Vec<TcpStream>>>::default();
        let theirs = Arc::clone(&connections);
        std::thread::spawn(move || slave.incoming().for_each(|stream| negotiate(stream.unwrap(), port)));
        let name = topic.to_owned();
        std::thread::spawn(move || {
            for stream in data.incoming() {
                let mut stream = stream.unwrap();
                if greet(&mut stream, &name).is_ok() {
                    theirs.lock().unwrap().push(stream);
                }
            }
        });
        let talking = Arc::clone(&connections);
        std::thread::spawn(move || {
            loop {
                std::thread::sleep(Duration::from_millis(100));
                talking.lock().unwrap().retain_mut(|stream| stream.write_all(&bytes).is_ok());
            }
        });
        let params = ["/fake", topic, "std_msgs/Bool", &uri];
        let params: String =
            params.iter().map(|p| format!("<param><value><string>{p}</string></value></param>")).collect();
        let body = format!(
            "<?xml version=\"1.0\"?><methodCall><methodName>registerPublisher</methodName><params>{params}</params></methodCall>"
        );
        let host = master.trim_start_matches("http://").trim_end_matches('/').to_owned();
        let mut stream = TcpStream::connect(&host).unwrap();
        write!(
            stream,
            "POST /RPC2 HTTP/1.1\r\nHost: {host}\r\nContent-Type: text/xml\r\nContent-Length: {}\r\nConnection: close\r\n\r\n{body}",
            body.len()
        )
        .unwrap();
        let mut answer = String::new();
        stream.read_to_string(&mut answer).unwrap();
        assert!(answer.contains("methodResponse"), "{answer}");
        Self { connections }
    }

    /// How many subscribers have met it and are still there.
    pub fn subscribers(&self) -> usize {
        self.connections.lock().unwrap().len()
    }

    /// Cuts all connections, as a network does.
    pub fn cut(&self) {
        for stream in self.connections.lock().unwrap().drain(..) {
            stream.shutdown(std::net::Shutdown::Both).unwrap();
        }
    }
}

/// Answers `requestTopic`, and everything else in the same way.
fn negotiate(mut stream: TcpStream, port: u16) {
    let mut request = Vec::new();
    let mut part = [0; 1024];
    while !String::from_utf8_lossy(&request).contains("</methodCall>") {
        match stream.read(&mut part) {
            Ok(n) if n > 0 => request.extend_from_slice(&part[..n]),
            _ => return,
        }
    }
    let string = |text: &str| format!("<value><string>{text}</string></value>");
    let int = |n: u16| format!("<value><i4>{n}</i4></value>");
    let array = |values: &[String]| format!("<value><array><data>{}</data></array></value>", values.concat());
    let protocol = array(&[string("TCPROS"), string("127.0.0.1"), int(port)]);
    let answer = array(&[int(1), string("ready"), protocol]);
    let body =
        format!("<?xml version=\"1.0\"?><methodResponse><params><param>{answer}</param></params></methodResponse>");
    let _ = write!(
        stream,
        "HTTP/1.1 200 OK\r\nContent-Type: text/xml\r\nContent-Length: {}\r\nConnection: close\r\n\r\n{body}",
        body.len()
    );
}

/// The headers of TCPROS.
fn greet(stream: &mut TcpStream, topic: &str) -> std::io::Result<()> {
    let mut length = [0; 4];
    stream.read_exact(&mut length)?;
    let mut header = vec![0; u32::from_le_bytes(length) as usize];
    stream.read_exact(&mut header)?;
    let fields = [
        "callerid=/fake".to_owned(),
        "md5sum=8b94c1b53db61fb6aed406028ad6332a".to_owned(),
        "type=std_msgs/Bool".to_owned(),
        format!("topic={topic}"),
    ];
    let sized = |bytes: &[u8]| [&u32::try_from(bytes.len()).unwrap().to_le_bytes(), bytes].concat();
    let all: Vec<u8> = fields.iter().flat_map(|field| sized(field.as_bytes())).collect();
    stream.write_all(&sized(&all))
}
