//! What live tests run on: nodes as processes, a probe inside the test, a deadline.

use frontier_explorer::ros::{Feed, Node};
use libtest_mimic::Failed;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// A test that takes longer has failed.
pub const DEADLINE: Duration = Duration::from_secs(120);

/// Names the test that a process is to run.
pub const CHILD: &str = "FRONTIER_LIVE_TEST";

/// The test that this process is to run and the port of its master, where another one started it
/// for a test.
pub fn own_test() -> Option<(String, u16)> {
    let name = std::env::var(CHILD).ok()?;
    Some((name, std::env::var("FRONTIER_LIVE_PORT").unwrap().parse().unwrap()))
}

/// Runs a test in a process of its own.
pub fn in_own_process(name: &str) -> Result<(), Failed> {
    let port = std::net::TcpListener::bind("127.0.0.1:0")?.local_addr()?.port();
    let output = Command::new(std::env::current_exe()?)
        .env(CHILD, name)
        .env("FRONTIER_LIVE_PORT", port.to_string())
        .env("ROS_MASTER_URI", format!("http://localhost:{port}"))
        .env("ROS_HOSTNAME", "localhost")
        .env_remove("ROS_NAMESPACE")
        .env_remove("ROS_IP")
        .output()?;
    if output.status.success() {
        return Ok(());
    }
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    Err(format!("{}{}", text(&output.stdout), text(&output.stderr)).into())
}

/// A process that is killed when the test ends.
pub struct Process {
    child: Child,
    log: PathBuf,
}

impl Process {
    /// Starts a program with its output in a file.
    pub fn start(program: impl AsRef<std::ffi::OsStr>, args: &[&str], log: PathBuf) -> Self {
        Self::start_in(program, args, log, &[])
    }

    /// The same with more variables in its environment.
    pub fn start_in(
        program: impl AsRef<std::ffi::OsStr>,
        args: &[&str],
        log: PathBuf,
        env: &[(String, String)],
    ) -> Self {
        let file = std::fs::File::create(&log).unwrap();
        let child = Command::new(program)
            .args(args)
            .envs(env.iter().cloned())
            .stdin(Stdio::null())
            .stdout(file.try_clone().unwrap())
            .stderr(file)
            .spawn()
            .unwrap();
        Self { child, log }
    }

    /// What it has written so far.
    pub fn log(&self) -> String {
        std::fs::read_to_string(&self.log).unwrap_or_default()
    }

    /// How it ended, if it has.
    pub fn try_wait(&mut self) -> Option<ExitStatus> {
        self.child.try_wait().unwrap()
    }

    /// Whether it has not ended.
    pub fn is_running(&mut self) -> bool {
        matches!(self.child.try_wait(), Ok(None))
    }

    /// Waits for its end.
    pub fn wait(&mut self, limit: Duration) -> ExitStatus {
        let began = Instant::now();
        loop {
            if let Some(status) = self.child.try_wait().unwrap() {
                return status;
            }
            assert!(began.elapsed() < limit, "still running after {limit:?}:\n{}", self.log());
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    /// Waits for its end and checks the exit code.
    pub fn expect_code(&mut self, code: i32, limit: Duration) {
        let status = self.wait(limit);
        assert_eq!(status.code(), Some(code), "{}", self.log());
    }

    /// Sends it a signal, such as TERM.
    pub fn signal(&self, name: &str) {
        let status = Command::new("kill").arg(format!("-{name}")).arg(self.child.id().to_string()).status().unwrap();
        assert!(status.success());
    }

    /// Its number.
    pub fn id(&self) -> u32 {
        self.child.id()
    }

    /// Waits until its log holds a text.
    pub fn expect_log(&self, text: &str, limit: Duration) {
        eventually(limit, || self.log().contains(text), || format!("{text:?} is not in:\n{}", self.log()));
    }
}

impl Drop for Process {
    /// Asks it to end, as roscore and roslaunch end their own children then, and makes it.
    fn drop(&mut self) {
        if self.is_running() {
            let _ = Command::new("kill").arg("-INT").arg(self.child.id().to_string()).status();
            let began = Instant::now();
            while self.is_running() && began.elapsed() < Duration::from_secs(8) {
                std::thread::sleep(Duration::from_millis(20));
            }
        }
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Waits until something holds.
pub fn eventually(limit: Duration, mut holds: impl FnMut() -> bool, why: impl Fn() -> String) {
    let began = Instant::now();
    while !holds() {
        assert!(began.elapsed() < limit, "not within {limit:?}: {}", why());
        std::thread::sleep(Duration::from_millis(20));
    }
}

/// The messages of a topic.
pub struct Heard<T> {
    messages: Arc<Mutex<Vec<T>>>,
    _feed: Feed,
}

impl<T: rosrust::Message> Heard<T> {
    /// Begins to listen.
    pub fn on(node: &Node, topic: &str) -> Self {
        let messages = Arc::<Mutex<Vec<T>>>::default();
        let theirs = Arc::clone(&messages);
        let feed = Feed::listen(node, topic, 50, Duration::from_secs(120), move |message: T, _| {
            theirs.lock().unwrap().push(message);
        });
        Self { messages, _feed: feed }
    }

    /// All so far.
    pub fn all(&self) -> Vec<T> {
        self.messages.lock().unwrap().clone()
    }

    /// The newest.
    pub fn last(&self) -> Option<T> {
        self.messages.lock().unwrap().last().cloned()
    }

    /// Waits for a message that fits.
    pub fn expect(&self, limit: Duration, what: &str, fits: impl Fn(&T) -> bool) -> T {
        let mut found = None;
        eventually(
            limit,
            || {
                found = self.all().into_iter().find(&fits);
                found.is_some()
            },
            || format!("{what}; the last was {:?}", self.last()),
        );
        found.unwrap()
    }
}

/// Two rooms of 3.5 x 3 m with a door of 1 m between them, as a map_server map.
pub fn small_house(folder: &Path) -> PathBuf {
    const WIDTH: usize = 160;
    const HEIGHT: usize = 70;
    let is_wall = |x: usize, y: usize| {
        let outer = x < 4 || y < 4 || x >= WIDTH - 4 || y >= HEIGHT - 4;
        let middle = (78..82).contains(&x) && !(25..47).contains(&y);
        outer || middle
    };
    write_house(folder, (WIDTH, HEIGHT), is_wall)
}

/// A house whose walls are said cell by cell from the lower left, 0.05 m each, as a map_server map.
pub fn write_house(folder: &Path, (width, height): (usize, usize), is_wall: impl Fn(usize, usize) -> bool) -> PathBuf {
    let mut image = format!("P5\n{width} {height}\n255\n").into_bytes();
    for row in 0..height {
        image.extend((0..width).map(|x| if is_wall(x, height - 1 - row) { 0 } else { 254 }));
    }
    std::fs::write(folder.join("house.pgm"), image).unwrap();
    let yaml = "image: house.pgm\nresolution: 0.05\norigin: [0.0, 0.0, 0.0]\nnegate: 0\noccupied_thresh: 0.65\n\
                free_thresh: 0.196\n";
    let path = folder.join("house.yaml");
    std::fs::write(&path, yaml).unwrap();
    path
}
