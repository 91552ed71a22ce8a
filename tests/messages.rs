//! The vendored message definitions against the md5 sums that ROS 1 has for them
//! (`rosmsg md5`): a connection with another sum is refused.

use ::frontier_explorer::ros::msg::{
    actionlib_msgs, diagnostic_msgs, dynamic_reconfigure, frontier_explorer as own, geometry_msgs, map_msgs,
    move_base_msgs, nav_msgs, rosgraph_msgs, sensor_msgs, std_msgs, std_srvs, tf2_msgs, visualization_msgs,
};
use rosrust::Message;

fn check<T: Message>(name: &str, md5: &str) {
    assert_eq!((T::msg_type().as_str(), T::md5sum().as_str()), (name, md5));
}

#[test]
fn messages_are_those_of_ros() {
    check::<std_msgs::Bool>("std_msgs/Bool", "8b94c1b53db61fb6aed406028ad6332a");
    check::<std_msgs::Header>("std_msgs/Header", "2176decaecbce78abc3b96ef049fabed");
    check::<std_msgs::String>("std_msgs/String", "992ce8a1687cec8c8bd883ec73ca41d1");
    check::<rosgraph_msgs::Clock>("rosgraph_msgs/Clock", "a9c97c1d230cfc112e270351a944ee47");
    check::<rosgraph_msgs::Log>("rosgraph_msgs/Log", "acffd30cd6b6de30f120938c17c593fb");
    check::<geometry_msgs::PointStamped>("geometry_msgs/PointStamped", "c63aecb41bfdfd6b7e1fac37c7cbe7bf");
    check::<geometry_msgs::PolygonStamped>("geometry_msgs/PolygonStamped", "c6be8f7dc3bee7fe9e8d296070f53340");
    check::<geometry_msgs::PoseStamped>("geometry_msgs/PoseStamped", "d3812c3cbc69362b77dc0b19b345f8f5");
    check::<geometry_msgs::TransformStamped>("geometry_msgs/TransformStamped", "b5764a33bfeb3588febc2682852579b0");
    check::<geometry_msgs::Twist>("geometry_msgs/Twist", "9f195f881246fdfa2798d1d3eebca84a");
    check::<nav_msgs::MapMetaData>("nav_msgs/MapMetaData", "10cfc8a2818024d3248802c00c95f11b");
    check::<nav_msgs::OccupancyGrid>("nav_msgs/OccupancyGrid", "3381f2d731d4076ec5c71b0759edbe4e");
    check::<nav_msgs::Odometry>("nav_msgs/Odometry", "cd5e73d190d741a2f92e81eda573aca7");
    check::<nav_msgs::Path>("nav_msgs/Path", "6227e2b7e9cce15051f669a5e197bbf7");
    check::<map_msgs::OccupancyGridUpdate>("map_msgs/OccupancyGridUpdate", "b295be292b335c34718bd939deebe1c9");
    check::<actionlib_msgs::GoalID>("actionlib_msgs/GoalID", "302881f31927c1df708a2dbab0e80ee8");
    check::<actionlib_msgs::GoalStatusArray>("actionlib_msgs/GoalStatusArray", "8b2b82f13216d0a8ea88bd3af735e619");
    check::<move_base_msgs::MoveBaseAction>("move_base_msgs/MoveBaseAction", "70b6aca7c7f7746d8d1609ad94c80bb8");
    check::<move_base_msgs::MoveBaseActionFeedback>(
        "move_base_msgs/MoveBaseActionFeedback",
        "7d1870ff6e0decea702b943b5af0b42e",
    );
    check::<move_base_msgs::MoveBaseActionGoal>(
        "move_base_msgs/MoveBaseActionGoal",
        "660d6895a1b9a16dce51fbdd9a64a56b",
    );
    check::<move_base_msgs::MoveBaseActionResult>(
        "move_base_msgs/MoveBaseActionResult",
        "1eb06eeff08fa7ea874431638cb52332",
    );
    check::<sensor_msgs::LaserScan>("sensor_msgs/LaserScan", "90c7ef2dc6895d81024acba2ac42f369");
    check::<tf2_msgs::TFMessage>("tf2_msgs/TFMessage", "94810edda583a504dfda3829e70d7eec");
    check::<visualization_msgs::MarkerArray>("visualization_msgs/MarkerArray", "d155b9ce5188fbaf89745847fd5882d7");
    check::<dynamic_reconfigure::Config>("dynamic_reconfigure/Config", "958f16a05573709014982821e6822580");
    check::<dynamic_reconfigure::ConfigDescription>(
        "dynamic_reconfigure/ConfigDescription",
        "757ce9d44ba8ddd801bb30bc456f946f",
    );
    check::<diagnostic_msgs::DiagnosticArray>("diagnostic_msgs/DiagnosticArray", "60810da900de1dd6ddd437c3503511da");
}

#[test]
fn services_are_those_of_ros() {
    check::<nav_msgs::GetMap>("nav_msgs/GetMap", "6cdd0a18e0aff5b0a3ca2326a89b54ff");
    check::<nav_msgs::GetPlan>("nav_msgs/GetPlan", "421c8ea4d21c6c9db7054b4bbdf1e024");
    check::<dynamic_reconfigure::Reconfigure>("dynamic_reconfigure/Reconfigure", "bb125d226a21982a4a98760418dc2672");
    check::<std_srvs::Empty>("std_srvs/Empty", "d41d8cd98f00b204e9800998ecf8427e");
    check::<std_srvs::Trigger>("std_srvs/Trigger", "937c9679a518e3a18d831e57125ea522");
}

#[test]
fn our_own_messages_live_in_our_package() {
    assert_eq!(own::FrontierArray::msg_type(), "frontier_explorer/FrontierArray");
    assert_eq!(own::ExplorationStatus::msg_type(), "frontier_explorer/ExplorationStatus");
}
