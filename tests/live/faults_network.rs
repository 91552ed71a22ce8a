//! Peers that do not keep to the protocols: silence, garbage, claims that no memory holds, a
//! subscriber that never reads; and a master that is restarted.

use crate::fake_publisher::FakePublisher;
use crate::peers::MASTER;
use crate::rig::{CHILD, DEADLINE, Heard, Process, eventually};
use crate::{EXACT, SOON, Test, World};
use frontier_explorer::ros::msg::frontier_explorer::ExplorationStatus;
use frontier_explorer::ros::msg::visualization_msgs::MarkerArray;
use rosrust::Message;
use std::io::{Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::time::{Duration, Instant};

pub const TESTS: &[Test] = &[
    ("silent_connections_on_every_port_hold_nobody_up", silent_connections),
    ("garbage_and_huge_claims_on_the_ports_of_topics_end_nothing", odd_topics),
    ("a_publisher_that_claims_four_gigabytes_ends_nothing", huge_publisher),
    ("requests_that_no_server_survives_are_survived_by_the_session", odd_requests),
    ("a_subscriber_that_never_reads_holds_nobody_up", never_reads),
    ("a_master_that_is_killed_and_restarted_ends_nothing", restarted_master),
];

/// The body of the answer to an XML-RPC request with strings.
fn ask(host: &str, method: &str, params: &str) -> String {
    let body = format!(
        "<?xml version=\"1.0\"?><methodCall><methodName>{method}</methodName><params>{params}</params></methodCall>"
    );
    let mut stream = TcpStream::connect(host).unwrap();
    stream.set_read_timeout(Some(Duration::from_secs(5))).unwrap();
    let length = body.len();
    write!(stream, "POST /RPC2 HTTP/1.1\r\nHost: {host}\r\nContent-Type: text/xml\r\nContent-Length: {length}\r\nConnection: close\r\n\r\n{body}").unwrap();
    let mut answer = String::new();
    let _ = stream.read_to_string(&mut answer);
    answer
}

fn string(text: &str) -> String {
    format!("<param><value><string>{text}</string></value></param>")
}

/// What stands between two words, after a first one.
fn between<'a>(text: &'a str, after: &str, begin: &str, end: &str) -> &'a str {
    let (_, rest) = text.split_once(after).unwrap_or_else(|| panic!("{after} is not in {text}"));
    let (_, rest) = rest.split_once(begin).unwrap_or_else(|| panic!("{begin} is not in {text}"));
    rest.split_once(end).unwrap().0
}

/// Where a node answers XML-RPC.
fn slave(node: &str) -> String {
    let master = std::env::var("ROS_MASTER_URI").unwrap();
    let host = master.trim_start_matches("http://").trim_end_matches('/').to_owned();
    let answer = ask(&host, "lookupNode", &(string("/test") + &string(node)));
    between(&answer, "methodResponse", "http://", "/").to_owned()
}

/// Where a node sends a topic.
fn topic_port(node: &str, topic: &str) -> u16 {
    let protocols = "<param><value><array><data><value><array><data><value><string>TCPROS</string></value></data>\
                     </array></value></data></array></value></param>";
    let answer = ask(&slave(node), "requestTopic", &(string("/test") + &string(topic) + protocols));
    let rest = answer.split_once("TCPROS").unwrap_or_else(|| panic!("{answer}")).1;
    let number = if rest.contains("<i4>") { between(rest, "", "<i4>", "<") } else { between(rest, "", "<int>", "<") };
    number.parse().unwrap()
}

fn connect(host: &str) -> TcpStream {
    TcpStream::connect(host).unwrap()
}

/// The ports on which a process listens.
fn ports_of(process: &Process) -> Vec<u16> {
    let fds = std::fs::read_dir(format!("/proc/{}/fd", process.id())).unwrap();
    let sockets: Vec<String> = fds
        .filter_map(|fd| std::fs::read_link(fd.ok()?.path()).ok())
        .filter_map(|to| Some(to.to_str()?.strip_prefix("socket:[")?.strip_suffix(']')?.to_owned()))
        .collect();
    let mut ports = Vec::new();
    for table in ["tcp", "tcp6"] {
        let text = std::fs::read_to_string(format!("/proc/{}/net/{table}", process.id())).unwrap();
        for line in text.lines().skip(1) {
            let fields: Vec<&str> = line.split_whitespace().collect();
            if fields[3] == "0A" && sockets.iter().any(|inode| inode == fields[9]) {
                ports.push(u16::from_str_radix(fields[1].rsplit(':').next().unwrap(), 16).unwrap());
            }
        }
    }
    ports
}

/// An explorer on the way, of which nothing is lost but by a fault.
fn begun(world: &World, status: &Heard<ExplorationStatus>) -> Process {
    let explore = world.explore(&[]);
    status.expect(DEADLINE, "driving", |m| m.phase == ExplorationStatus::DRIVING);
    explore
}

fn expect_complete(world: &World, sim: &mut Process, explore: &mut Process) {
    explore.expect_code(0, DEADLINE);
    assert!(explore.log().contains("complete: "), "{}", explore.log());
    world.expect_explored(sim, EXACT);
}

/// It leaves in time, and with its map.
fn expect_leaving(world: &World, explore: &mut Process) {
    let began = Instant::now();
    explore.signal("TERM");
    explore.expect_code(0, SOON);
    assert!(began.elapsed() < Duration::from_millis(2200), "{:?}:\n{}", began.elapsed(), explore.log());
    assert!(world.map().with_extension("pgm").exists(), "{}", explore.log());
}

fn silent_connections(world: &World) {
    let status = Heard::<ExplorationStatus>::on(&world.probe, "/explore/status");
    let mut sim = world.simulate_kindly(&["_speed:=4"]);
    let mut explore = begun(world, &status);
    let ports = ports_of(&explore);
    assert!(ports.len() > 5, "{ports:?}");
    let silent: Vec<TcpStream> =
        ports.iter().flat_map(|port| (0..3).map(move |_| connect(&format!("localhost:{port}")))).collect();
    expect_complete(world, &mut sim, &mut explore);
    let _sim = world.simulate_kindly(&[]);
    let mut explore = world.explore(&["_exit_when_done:=false"]);
    explore.expect_log("best of", SOON);
    let more: Vec<TcpStream> = ports_of(&explore).iter().map(|port| connect(&format!("localhost:{port}"))).collect();
    std::thread::sleep(Duration::from_millis(500));
    expect_leaving(world, &mut explore);
    drop((silent, more));
}

fn odd_topics(world: &World) {
    let status = Heard::<ExplorationStatus>::on(&world.probe, "/explore/status");
    let mut sim = world.simulate_kindly(&["_speed:=4"]);
    let mut explore = begun(world, &status);
    let four_gigabytes = [&[0xff_u8; 4][..], b"x"].concat();
    let nested = [&20_u32.to_le_bytes()[..], &u32::MAX.to_le_bytes(), &[b'='; 16]].concat();
    let garbage: Vec<u8> = (0..4096_u32).map(|i| (i.wrapping_mul(2_654_435_761) >> 13) as u8).collect();
    let mut open = Vec::new();
    for topic in ["/explore/status", "/explore/frontiers", "/move_base/goal", "/cmd_vel"] {
        let host = format!("localhost:{}", topic_port("/explore", topic));
        for bytes in [&four_gigabytes, &nested, &garbage] {
            let mut stream = connect(&host);
            let _ = stream.write_all(bytes);
            open.push(stream);
        }
    }
    let heard = status.all().len();
    eventually(SOON, || status.all().len() > heard + 1, || explore.log());
    expect_complete(world, &mut sim, &mut explore);
    assert!(!explore.log().contains("panicked"), "{}", explore.log());
}

/// What one publisher claims is lost, and nothing else.
fn huge_publisher(world: &World) {
    let status = Heard::<ExplorationStatus>::on(&world.probe, "/explore/status");
    let master = std::env::var("ROS_MASTER_URI").unwrap();
    let huge = FakePublisher::telling(&master, "/explore/resume", vec![0xff; 8]);
    let mut sim = world.simulate_kindly(&["_speed:=4"]);
    let mut explore = world.explore(&[]);
    eventually(SOON, || huge.subscribers() > 0, || "nobody subscribes".to_owned());
    status.expect(DEADLINE, "driving", |m| m.phase == ExplorationStatus::DRIVING);
    let memory = std::fs::read_to_string(format!("/proc/{}/status", explore.id())).unwrap();
    let resident_kb: u64 = between(&memory, "VmRSS", ":", "kB").trim().parse().unwrap();
    assert!(resident_kb < 500_000, "{resident_kb} kB");
    expect_complete(world, &mut sim, &mut explore);
}

/// A huge claim and a deep nest on the port of XML-RPC: the process may end of it. Then one that is
/// started again, as `respawn` does, goes on within five seconds.
fn odd_requests(world: &World) {
    let status_of = Heard::<ExplorationStatus>::on(&world.probe, "/explore/status");
    let session = world.folder.join("session.json").display().to_string();
    let (keep, resume) = (format!("_session_file:={session}"), format!("_resume_from:={session}"));
    let args = [keep.as_str(), &resume, "_session_period:=0.3"];
    let mut sim = world.simulate_kindly(&["_speed:=2"]);
    let mut explore = world.explore(&args);
    status_of.expect(DEADLINE, "driving", |m| m.phase == ExplorationStatus::DRIVING);
    eventually(SOON, || Path::new(&session).exists(), || explore.log());
    let nest = "<value><array><data>".repeat(10_000);
    let deep = format!("<?xml version=\"1.0\"?><methodCall><methodName>getPid</methodName><params><param>{nest}");
    let header = |length: &str| format!("POST /RPC2 HTTP/1.1\r\nHost: x\r\nContent-Length: {length}\r\n\r\n");
    let requests = [header("18446744073709551615"), header(&deep.len().to_string()) + &deep];
    for request in requests {
        let mut stream = connect(&slave("/explore"));
        let _ = stream.write_all(request.as_bytes());
        std::thread::sleep(Duration::from_millis(700));
        drop(stream);
        if let Some(status) = explore.try_wait() {
            eprintln!("it ended: {status}\n{}", explore.log());
            let (began, before) = (Instant::now(), status_of.all().len());
            explore = world.explore(&args);
            explore.expect_log("going on with the session of", SOON);
            let moves =
                |m: &ExplorationStatus| [ExplorationStatus::TURNING, ExplorationStatus::DRIVING].contains(&m.phase);
            eventually(SOON, || status_of.all().iter().skip(before).any(moves), || explore.log());
            assert!(began.elapsed() < Duration::from_secs(5), "{:?}", began.elapsed());
        }
    }
    expect_complete(world, &mut sim, &mut explore);
}

/// A subscription by hand, of which nothing is ever read.
fn subscribe<T: Message>(topic: &str) -> TcpStream {
    let mut stream = connect(&format!("localhost:{}", topic_port("/explore", topic)));
    let fields = [
        "callerid=/never_reads".to_owned(),
        format!("md5sum={}", T::md5sum()),
        format!("type={}", T::msg_type()),
        format!("topic={topic}"),
    ];
    let sized = |bytes: &[u8]| [&u32::try_from(bytes.len()).unwrap().to_le_bytes(), bytes].concat();
    let all: Vec<u8> = fields.iter().flat_map(|field| sized(field.as_bytes())).collect();
    stream.write_all(&sized(&all)).unwrap();
    stream
}

fn never_reads(world: &World) {
    let status = Heard::<ExplorationStatus>::on(&world.probe, "/explore/status");
    let mut sim = world.simulate_kindly(&["_speed:=4"]);
    let mut explore = begun(world, &status);
    let _deaf: Vec<TcpStream> = (0..4)
        .flat_map(|_| {
            let status = subscribe::<ExplorationStatus>("/explore/status");
            [status, subscribe::<MarkerArray>("/explore/frontiers"), subscribe::<MarkerArray>("/explore/areas")]
        })
        .collect();
    expect_complete(world, &mut sim, &mut explore);
    status.expect(SOON, "the end", |m| m.phase == ExplorationStatus::ENDED);
}

fn restarted_master(world: &World) {
    let port = std::net::TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
    let env = [
        ("ROS_MASTER_URI".to_owned(), format!("http://localhost:{port}")),
        (CHILD.to_owned(), MASTER.to_owned()),
        ("FRONTIER_LIVE_PORT".to_owned(), port.to_string()),
    ];
    let program = std::env::current_exe().unwrap();
    let start = || Process::start_in(&program, &[], world.folder.join("master.log"), &env);
    let mut master = start();
    let host = format!("localhost:{port}");
    eventually(SOON, || TcpStream::connect(&host).is_ok(), || master.log());
    let yes = "<param><value><boolean>1</boolean></value></param>";
    ask(&host, "setParam", &(string("/test") + &string("/use_sim_time") + yes));
    let house = format!("_world:={}", world.house.display());
    let sim_args = [house.as_str(), "_start:=[2.0, 1.7]", "_speed:=4", "_slam:=perfect", "_driver:=navigator"];
    let sim_log = world.folder.join("sim.log");
    let _sim = Process::start_in(env!("CARGO_BIN_EXE_sim_node"), &sim_args, sim_log, &env[..1]);
    let map_file = format!("_map_file:={}", world.map().display());
    let args = [map_file.as_str(), "_config:=wfd", "_exit_when_done:=true"];
    let log = world.folder.join("explore.log");
    let mut explore = Process::start_in(env!("CARGO_BIN_EXE_explore_node"), &args, log, &env[..1]);
    explore.expect_log("map on map, goals to move_base", SOON);
    explore.expect_log("best of", SOON);
    master.signal("KILL");
    master.wait(SOON);
    std::thread::sleep(Duration::from_secs(1));
    let _second = start();
    explore.expect_code(0, DEADLINE);
    assert!(explore.log().contains("complete: "), "{}", explore.log());
    assert!(world.map().with_extension("pgm").exists(), "{}", explore.log());
}
