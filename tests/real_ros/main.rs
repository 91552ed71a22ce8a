//! The nodes against Debian's ROS 1: roscore, rospy, actionlib, tf2_ros, rosbag,
//! roslaunch, rosrun and a catkin workspace. Without ROS the tests are skipped, and say
//! so; `FRONTIER_REQUIRE_ROS=1` makes that a failure.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::print_stderr)]

#[path = "../live/rig.rs"]
#[allow(dead_code)]
mod rig;

use frontier_explorer::geometry::Pose;
use frontier_explorer::io::load_map;
use frontier_explorer::tf::TransformSample;
use libtest_mimic::{Arguments, Failed, Trial};
use rig::{DEADLINE, Process, eventually, small_house};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;
use std::time::Duration;

const SOON: Duration = Duration::from_secs(30);
/// Messages are generated for C++, Python and Lisp.
const BUILD: Duration = Duration::from_secs(300);

/// A test by its name.
type Test = (&'static str, fn(&Stage));

const TESTS: &[Test] = &[
    ("a_stack_of_real_parts_is_explored", real_parts),
    ("rosnode_kill_and_rostopic_and_rosparam_work", tools),
    ("dynparam_lists_and_sets_what_may_change", dynparam),
    ("rosbag_records_a_run", rosbag),
    ("rosbag_reads_and_plays_our_bags", our_bags),
    ("catkin_builds_and_roslaunch_runs_the_demo", demo_launch),
    ("a_mission_script_orders_an_exploration", mission),
    ("the_launch_file_of_explore_lite_works", explore_lite_launch),
    ("a_killed_master_does_not_end_the_exploration", killed_master),
    ("a_restarted_master_does_not_end_the_exploration", restarted_master),
    ("message_definitions_are_those_of_the_installation", messages),
];

fn main() {
    let missing: Vec<&str> =
        ["roscore", "roslaunch", "rostopic", "rosbag", "catkin_make"].into_iter().filter(|p| !is_there(p)).collect();
    let trials: Vec<Trial> = if missing.is_empty() {
        TESTS.iter().map(|(name, test)| Trial::test(*name, move || run(*test))).collect()
    } else if std::env::var_os("FRONTIER_REQUIRE_ROS").is_some() {
        let why = format!("FRONTIER_REQUIRE_ROS is set, and these programs of ROS are missing: {}", missing.join(", "));
        vec![Trial::test("ros_is_installed", move || Err(why.into()))]
    } else {
        let bar = "=".repeat(78);
        eprintln!("{bar}\nSKIPPED: {} tests against a real ROS 1, as these programs are missing:", TESTS.len());
        eprintln!("  {}\nOn Debian 12: apt install ros-base rosbash (see .ci/run)\n{bar}", missing.join(", "));
        TESTS.iter().map(|(name, _)| Trial::test(*name, || Ok(())).with_ignored_flag(true)).collect()
    };
    let mut arguments = Arguments::from_args();
    arguments.test_threads.get_or_insert(1);
    let conclusion = libtest_mimic::run(&arguments, trials);
    if let Some(workspace) = WORKSPACE.get() {
        // What a static holds is dropped by nobody.
        let _ = std::fs::remove_dir_all(workspace.path());
    }
    conclusion.exit();
}

fn is_there(program: &str) -> bool {
    std::env::split_paths(&std::env::var_os("PATH").unwrap_or_default()).any(|folder| folder.join(program).is_file())
}

fn run(test: fn(&Stage)) -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    std::panic::catch_unwind(|| test(&Stage::begin(folder.path()))).map_err(|panic| {
        let text = panic.downcast_ref::<String>().cloned();
        text.or_else(|| panic.downcast_ref::<&str>().map(|&s| s.to_owned())).unwrap_or_default().into()
    })
}

/// A roscore of its own, and a folder.
struct Stage {
    folder: PathBuf,
    uri: String,
    roscore: Process,
}

impl Stage {
    fn begin(folder: &Path) -> Self {
        let port = std::net::TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
        let uri = format!("http://localhost:{port}");
        let log = folder.join("roscore.log");
        let script = format!("exec roscore -p {port}");
        let roscore = Process::start_in("bash", &["-c", &script], log, &env(&uri, folder));
        eventually(SOON, || frontier_explorer::ros::probe(&uri).is_ok(), || roscore.log());
        Self { folder: folder.to_owned(), uri, roscore }
    }

    /// Starts a shell command with this stage's master.
    fn start(&self, name: &str, command: &str) -> Process {
        let log = self.folder.join(format!("{name}.log"));
        Process::start_in("bash", &["-c", &format!("exec {command}")], log, &env(&self.uri, &self.folder))
    }

    /// Runs a shell command to its end and returns what it printed.
    fn output(&self, command: &str) -> String {
        let mut shell = Command::new("bash");
        shell.args(["-c", command]).envs(env(&self.uri, &self.folder));
        let output = shell.output().unwrap();
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        let errors = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{command}: {}\n{text}{errors}", output.status);
        text
    }

    fn sim(&self, more: &str) -> Process {
        let house = small_house(&self.folder);
        self.output("rosparam set /use_sim_time true");
        let command = format!(
            "{} _world:={} _speed:=8.0 '_start:=[2.0, 1.7]' {more}",
            env!("CARGO_BIN_EXE_sim_node"),
            house.display()
        );
        self.start("sim", &command)
    }

    fn explore(&self, more: &str) -> Process {
        let map = self.folder.join("map");
        let program = env!("CARGO_BIN_EXE_explore_node");
        self.start("explore", &format!("{program} _map_file:={} {more}", map.display()))
    }
}

fn env(uri: &str, folder: &Path) -> Vec<(String, String)> {
    let pairs = [("ROS_MASTER_URI", uri), ("ROS_HOSTNAME", "localhost"), ("ROS_LOG_DIR", &folder.to_string_lossy())];
    pairs.map(|(key, value)| (key.to_owned(), value.to_owned())).to_vec()
}

fn source(file: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(file)
}

fn real_parts(stage: &Stage) {
    let stack = stage.start("stack", &format!("/usr/bin/python3 {}", source("tests/real_ros/stack.py").display()));
    let mut explore = stage.explore("_exit_when_done:=true _base_frame:=base_link");
    explore.expect_code(0, DEADLINE);
    let saved = load_map(&stage.folder.join("map.yaml")).unwrap().grid;
    let free_m2 = saved.census(&Default::default()).free as f64 * 0.0025;
    assert!((22.0..24.5).contains(&free_m2), "{free_m2} m2 free\n{}{}", explore.log(), stack.log());
}

fn tools(stage: &Stage) {
    let mut sim = stage.sim("");
    // From the beginning on: a small house is explored before a tool that starts then listens.
    let mut markers = stage.start("markers", "rostopic echo /explore/frontiers");
    let mut explore = stage.explore("");
    explore.expect_log("best of", DEADLINE);
    let nodes = stage.output("rosnode list");
    assert!(nodes.contains("/sim") && nodes.contains("/explore"), "{nodes}");
    markers.expect_log("ns: \"frontiers\"", DEADLINE);
    markers.signal("INT");
    markers.wait(SOON);
    let look_up = source("tests/real_ros/look_up.py");
    let tf = stage.output(&format!("timeout 40 /usr/bin/python3 {} map base_scan", look_up.display()));
    assert!(tf.contains("translation"), "{tf}");
    assert!(stage.output("rosservice call /explore/save_map").contains("success: True"));
    assert_eq!(stage.output("rosparam get /explore/map_file").trim(), stage.folder.join("map").to_string_lossy());
    let scan = stage.output("timeout 20 rostopic echo -n 1 /scan/range_max");
    assert!(scan.contains("12.0"), "{scan}");
    stage.output("rosnode kill /explore");
    explore.expect_code(0, SOON);
    stage.output("rosnode kill /sim");
    sim.expect_code(0, SOON);
    let left = stage.output("rosnode list");
    assert!(!left.contains("/sim") && !left.contains("/explore"), "all is unregistered: {left}");
    let topics = stage.output("rostopic list");
    assert!(!topics.contains("/explore/"), "all is unregistered: {topics}");
}

fn dynparam(stage: &Stage) {
    // Debian's script is for the Python of Debian.
    let tool = |arguments: &str| {
        stage.output(&format!("PATH=/usr/bin:$PATH timeout 40 rosrun dynamic_reconfigure dynparam {arguments}"))
    };
    let get = |name: &str| stage.output(&format!("rosparam get /explore/{name}")).trim().to_owned();
    let mut explore = stage.explore("_config:=wfd");
    let listed = || tool("list").lines().any(|line| line == "/explore");
    eventually(SOON, listed, || explore.log());
    let all = tool("get /explore");
    assert!(all.contains("'min_size': 0.3") && all.contains("'nearest_by': 'euclidean'"), "{all}");
    tool("set /explore min_size 1");
    tool("set /explore \"{'nearest_by': 'path', 'visualize': False, 'max_failures': 4}\"");
    let all = tool("get /explore");
    for now in ["'min_size': 1.0", "'nearest_by': 'path'", "'visualize': False", "'max_failures': 4"] {
        assert!(all.contains(now), "{now} is not in {all}");
    }
    assert_eq!((get("min_size").as_str(), get("nearest_by").as_str()), ("1.0", "path"));
    assert_eq!(get("effective/preset/explorer/detector/min_size_m"), "1.0");
    assert_eq!(get("effective/robot/name"), "turtlebot2");
    let refused = tool("set /explore min_size 11 2>&1 || true");
    let why = "min_size is 11.0: must be a number within 0 to 10; nothing is changed";
    assert!(refused.contains(why), "{refused}");
    explore.expect_log(why, SOON);
    assert_eq!(get("min_size"), "1.0");
    stage.output("rosnode kill /explore");
    // No map has come that could be saved.
    explore.expect_code(1, SOON);
    // The next one keeps what was set, and reads the rest of what was told as nobody's wish.
    let mut again = stage.explore("_config:=tour");
    again.expect_log("~min_size is 1", SOON);
    eventually(SOON, listed, || again.log());
    let all = tool("get /explore");
    assert!(all.contains("'min_size': 1.0") && all.contains("'reconsider_period': 1.0"), "{all}");
    again.signal("INT");
    again.expect_code(1, SOON);
}

fn rosbag(stage: &Stage) {
    let _sim = stage.sim("");
    let bag = stage.folder.join("run.bag");
    let topics = "/map /tf /tf_static /scan /move_base/goal /move_base/result /explore/frontiers";
    let mut record = stage.start("record", &format!("rosbag record -O {} {topics}", bag.display()));
    let mut explore = stage.explore("_exit_when_done:=true _config:=wfd");
    explore.expect_code(0, DEADLINE);
    record.signal("INT");
    record.wait(SOON);
    // The recorder is a child of `rosbag`, and closes its bag in its own time.
    eventually(SOON, || bag.exists(), || record.log());
    let info = stage.output(&format!("rosbag info -y {}", bag.display()));
    for topic in topics.split(' ') {
        assert!(info.contains(&format!("topic: {topic}\n")), "{topic} is not in\n{info}");
    }
    assert!(info.contains("md5: 3381f2d731d4076ec5c71b0759edbe4e"), "{info}");
    // A replay of it decides as the node did: at 8 times real time a decision may fall to
    // another map, so that not all of the few need agree.
    let (frontier, out) = (env!("CARGO_BIN_EXE_frontier"), stage.folder.join("replay"));
    let said = stage.output(&format!("{frontier} replay {} --config wfd --out {}", bag.display(), out.display()));
    let comparison = std::fs::read(out.join("comparison.json")).unwrap();
    let comparison: serde_json::Value = serde_json::from_slice(&comparison).unwrap();
    let count = |key: &str| comparison[key].as_u64().unwrap();
    assert!(count("decisions") >= 1 && 2 * count("agreeing") >= count("decisions"), "{said}");
}

fn our_bags(stage: &Stage) {
    let house = small_house(&stage.folder);
    let (frontier, bag) = (env!("CARGO_BIN_EXE_frontier"), stage.folder.join("ours.bag"));
    let out = stage.folder.join("out");
    stage.output(&format!(
        "{frontier} explore {} --start 2.0,1.7 --quiet --bag {} --out {}",
        house.display(),
        bag.display(),
        out.display()
    ));
    let info = stage.output(&format!("rosbag info -y {}", bag.display()));
    assert!(
        info.contains("version: 2.0") && info.contains("indexed: True") && info.contains("compression: lz4"),
        "{info}"
    );
    let count = source("tests/real_ros/count.py");
    let counts = stage.output(&format!("/usr/bin/python3 {} {}", count.display(), bag.display()));
    for topic in
        ["/clock=", "/map=", "/move_base/goal=", "/move_base/result=", "/odom=", "/scan=", "/tf=", "/tf_static=1"]
    {
        assert!(counts.contains(topic), "{topic} is not among {counts}");
    }
    // Every way of compression, and back.
    for way in ["none", "bz2", "lz4"] {
        let other = stage.folder.join(format!("{way}.bag"));
        write_bag(&other, way);
        let info = stage.output(&format!("rosbag info -y {}", other.display()));
        assert!(info.contains(&format!("compression: {way}")) && info.contains("messages: 40"), "{info}");
        let counts = stage.output(&format!("/usr/bin/python3 {} {}", count.display(), other.display()));
        assert_eq!(counts.trim(), "/move_base/goal=20 /tf=20");
        // Our definitions hold no comments: to `rosbag check` that is another text.
        let checked = stage.output(&format!("rosbag check {}", other.display()));
        assert!(checked.contains("All rules defined"), "{checked}");
    }
    // Played, its messages arrive.
    let mut play = stage.start("play", &format!("rosbag play --rate 20 --delay 1 {}", bag.display()));
    let width = stage.output("rostopic echo -n 1 /map/info/width");
    assert!(width.trim().starts_with(|first: char| first.is_ascii_digit()), "{width}");
    play.wait(DEADLINE);
}

/// A bag of transforms and goals.
fn write_bag(path: &Path, way: &str) {
    use frontier_explorer::bag::{BagWriter, Compression, Header, MessageType, goal_message, nanos, tf_message};
    let compression = Compression::from_name(way).unwrap();
    let mut writer = BagWriter::new(std::fs::File::create(path).unwrap(), compression).unwrap();
    let tf = writer.topic("/tf", MessageType::Transforms, false);
    let goal = writer.topic("/move_base/goal", MessageType::Goal, false);
    for tick in 1..=20 {
        let stamp_s = f64::from(tick);
        let header = Header { seq: tick, stamp: nanos(stamp_s), frame: "map".to_owned() };
        let pose = Pose::new(stamp_s, 0.0, 0.0);
        let sample = TransformSample::planar(stamp_s, "odom", "base_link", &pose);
        writer.write(tf, nanos(stamp_s), &tf_message(&[sample])).unwrap();
        writer.write(goal, nanos(stamp_s), &goal_message(&header, "one", &pose)).unwrap();
    }
    writer.finish().unwrap();
}

static WORKSPACE: OnceLock<tempfile::TempDir> = OnceLock::new();

/// A catkin workspace with this package, built once for all tests.
fn workspace() -> &'static Path {
    let build = || {
        let root = tempfile::tempdir().unwrap();
        let package = root.path().join("src/frontier_explorer");
        std::fs::create_dir_all(&package).unwrap();
        // All but what cargo built: roslaunch looks through the whole package.
        for entry in std::fs::read_dir(source("")).unwrap() {
            let entry = entry.unwrap();
            if entry.file_name() != "target" {
                std::os::unix::fs::symlink(entry.path(), package.join(entry.file_name())).unwrap();
            }
        }
        let binaries = Path::new(env!("CARGO_BIN_EXE_explore_node")).parent().unwrap();
        let command = format!(
            "cd {} && catkin_make install -DPYTHON_EXECUTABLE=/usr/bin/python3 -DFRONTIER_EXPLORER_BINARIES={}",
            root.path().display(),
            binaries.display()
        );
        let log = root.path().join("build.log");
        let mut build = Process::start_in("bash", &["-c", &command], log, &[]);
        let status = build.wait(BUILD);
        assert!(status.success(), "{}", build.log());
        root
    };
    WORKSPACE.get_or_init(build).path()
}

fn with_workspace(space: &str, command: &str) -> String {
    format!("bash -c 'source {}/{space}/setup.bash && exec {command}'", workspace().display())
}

fn demo_launch(stage: &Stage) {
    let house = small_house(&stage.folder);
    for space in ["devel", "install"] {
        let map = stage.folder.join(space);
        let launch = format!(
            "roslaunch frontier_explorer demo_sim.launch world:={} start:=\"[2.0, 1.7]\" speed:=8.0 map_file:={} \
             exit_when_done:=true",
            house.display(),
            map.display()
        );
        let mut demo = stage.start(space, &with_workspace(space, &launch));
        demo.expect_code(0, DEADLINE);
        assert!(demo.log().contains("complete: "), "{}", demo.log());
        let saved = load_map(&map.with_extension("yaml")).unwrap().grid;
        assert!(saved.census(&Default::default()).free as f64 * 0.0025 > 22.0, "{}", demo.log());
        let found = stage.output(&with_workspace(space, "rosrun frontier_explorer frontier --version"));
        assert!(found.starts_with("frontier "), "{found}");
        let message = stage.output(&with_workspace(space, "rosmsg show frontier_explorer/FrontierArray"));
        assert!(message.contains("frontier_explorer/Frontier[] frontiers"), "{message}");
    }
    let nodes = stage.output("rosnode list");
    assert!(!nodes.contains("explore") && !nodes.contains("sim"), "nothing is left behind: {nodes}");
}

fn mission(stage: &Stage) {
    let _sim = stage.sim("_slam:=perfect _driver:=navigator");
    let mut explore = stage.explore("_autostart:=false _config:=wfd");
    explore.expect_log("waiting to be started", SOON);
    let script = source("examples/mission.py");
    let orders = "0,0 3.7,0 3.7,3.5 0,3.5 --errand 1.0,1.2 --time-limit 300";
    let command = format!("/usr/bin/python3 {} {orders}", script.display());
    let mut mission = stage.start("mission", &with_workspace("devel", &command));
    mission.expect_code(0, DEADLINE);
    let log = mission.log();
    for said in ["pause: paused: the robot stands", "the errand is done", "resume: going on", "back at the start"] {
        assert!(log.contains(said), "{said:?} is not in:\n{log}{}", explore.log());
    }
    assert!(log.contains("outside_region: ") && log.contains("map.yaml"), "{log}");
    // What the real roscore and rospy know of the services.
    let service = |name: &str| stage.output(&format!("rosservice call /explore/{name}"));
    assert!(service("stop").contains("nothing to stop: the exploration has ended"));
    // rosservice folds long texts.
    let why: String = service("explain").chars().filter(|c| !(c.is_whitespace() || *c == '\\')).collect();
    assert!(why.contains("lastdecision:"), "{why}");
    let action = stage.output(&with_workspace("devel", "rostopic type /explore/explore/goal"));
    assert_eq!(action.trim(), "frontier_explorer/ExploreActionGoal");
    explore.signal("INT");
    explore.expect_code(0, SOON);
}

fn explore_lite_launch(stage: &Stage) {
    let _sim = stage.sim("");
    let file = source("tests/real_ros/explore_lite.launch");
    let mut launch = stage.start("launch", &with_workspace("devel", &format!("roslaunch {}", file.display())));
    launch.expect_log("complete: ", DEADLINE);
    assert!(launch.log().contains("preset explore_lite"), "{}", launch.log());
    launch.signal("INT");
    launch.wait(SOON);
}

fn killed_master(stage: &Stage) {
    let _sim = stage.sim("");
    let mut explore = stage.explore("_exit_when_done:=true");
    explore.expect_log("best of", DEADLINE);
    stage.roscore.signal("INT");
    explore.expect_code(0, DEADLINE);
    assert!(explore.log().contains("complete: "), "{}", explore.log());
    assert!(stage.folder.join("map.pgm").exists(), "{}", explore.log());
}

fn restarted_master(stage: &Stage) {
    let _sim = stage.sim("_slam:=perfect _driver:=navigator");
    let mut explore = stage.explore("_exit_when_done:=true _config:=wfd");
    explore.expect_log("best of", DEADLINE);
    stage.roscore.signal("INT");
    eventually(SOON, || frontier_explorer::ros::probe(&stage.uri).is_err(), || stage.roscore.log());
    let port = stage.uri.rsplit(':').next().unwrap();
    let _second = stage.start("roscore_again", &format!("roscore -p {port}"));
    explore.expect_code(0, DEADLINE);
    assert!(explore.log().contains("complete: "), "{}", explore.log());
    assert!(stage.folder.join("map.pgm").exists(), "{}", explore.log());
}

fn messages(stage: &Stage) {
    for name in [
        "nav_msgs/OccupancyGrid",
        "geometry_msgs/PoseStamped",
        "actionlib_msgs/GoalStatusArray",
        "tf2_msgs/TFMessage",
        "visualization_msgs/MarkerArray",
        "dynamic_reconfigure/Config",
        "dynamic_reconfigure/ConfigDescription",
    ] {
        let md5 = stage.output(&format!("rosmsg md5 {name}"));
        let tests = std::fs::read_to_string(source("tests/messages.rs")).unwrap();
        assert!(tests.contains(md5.trim()), "{name} has {md5}");
    }
}
