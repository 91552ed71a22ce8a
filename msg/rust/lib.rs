//! The ROS messages, generated from the definitions beside this package.
#![allow(missing_docs, clippy::all, clippy::pedantic, clippy::nursery)]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::needless_pass_by_value, clippy::uninlined_format_args)]

rosrust::rosmsg_include!(
    std_msgs / Bool,
    std_msgs / Header,
    std_msgs / String,
    rosgraph_msgs / Clock,
    rosgraph_msgs / Log,
    geometry_msgs / PointStamped,
    geometry_msgs / PolygonStamped,
    geometry_msgs / PoseStamped,
    geometry_msgs / TransformStamped,
    geometry_msgs / Twist,
    nav_msgs / GetMap,
    nav_msgs / GetPlan,
    nav_msgs / MapMetaData,
    nav_msgs / OccupancyGrid,
    nav_msgs / Odometry,
    nav_msgs / Path,
    map_msgs / OccupancyGridUpdate,
    actionlib_msgs / GoalID,
    actionlib_msgs / GoalStatusArray,
    move_base_msgs / MoveBaseAction,
    move_base_msgs / MoveBaseActionFeedback,
    move_base_msgs / MoveBaseActionGoal,
    move_base_msgs / MoveBaseActionResult,
    sensor_msgs / LaserScan,
    tf2_msgs / TFMessage,
    visualization_msgs / MarkerArray,
    std_srvs / Empty,
    std_srvs / Trigger,
    diagnostic_msgs / DiagnosticArray,
    frontier_explorer / ExplorationStatus,
    frontier_explorer / FrontierArray
);
