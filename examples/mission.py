#!/usr/bin/env python3
"""A mission: explore a region, break off for an errand of one's own, go on, and come home.

    rosrun frontier_explorer explore_node __name:=explore _autostart:=false ...
    ./mission.py 0,0 3.7,0 3.7,3.5 0,3.5 --errand 1.0,1.2 --time-limit 600

Corners and places are metres of the map frame; without corners everything is explored. It
ends with 0 when the exploration ended as it should."""
import argparse
import sys

import actionlib
import rospy
from actionlib_msgs.msg import GoalStatus
from frontier_explorer.msg import ExplorationStatus, ExploreAction, ExploreGoal
from geometry_msgs.msg import Point32
from move_base_msgs.msg import MoveBaseAction, MoveBaseGoal
from std_srvs.srv import Trigger


def point(text):
    x, y = text.split(",")
    return float(x), float(y)


def call(explorer, control):
    """Calls a service of the explorer and says what it answered."""
    name = f"{explorer}/{control}"
    rospy.wait_for_service(name, timeout=20)
    answer = rospy.ServiceProxy(name, Trigger)()
    rospy.loginfo("%s: %s", control, answer.message)
    return answer.success


def run_errand(place):
    """Drives somewhere by a goal of our own; whether the robot got there."""
    move_base = actionlib.SimpleActionClient("move_base", MoveBaseAction)
    move_base.wait_for_server()
    goal = MoveBaseGoal()
    goal.target_pose.header.frame_id = "map"
    goal.target_pose.header.stamp = rospy.Time.now()
    goal.target_pose.pose.position.x, goal.target_pose.pose.position.y = place
    goal.target_pose.pose.orientation.w = 1.0
    return move_base.send_goal_and_wait(goal) == GoalStatus.SUCCEEDED


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("corners", nargs="*", type=point, metavar="X,Y")
    parser.add_argument("--errand", type=point, metavar="X,Y")
    parser.add_argument("--time-limit", type=float, default=0.0, metavar="SECONDS")
    parser.add_argument("--explorer", default="/explore", metavar="NODE")
    options = parser.parse_args(rospy.myargv()[1:])
    rospy.init_node("mission")

    driven = []
    explore = actionlib.SimpleActionClient(f"{options.explorer}/explore", ExploreAction)
    explore.wait_for_server()
    goal = ExploreGoal(return_home=True, time_limit_s=options.time_limit)
    goal.region.header.frame_id = "map"
    goal.region.polygon.points = [Point32(x, y, 0) for x, y in options.corners]
    explore.send_goal(goal, feedback_cb=lambda feedback: driven.append(feedback.status))

    # The errand comes once the robot has really set out.
    rate = rospy.Rate(20)
    while not rospy.is_shutdown() and explore.get_state() in (GoalStatus.PENDING, GoalStatus.ACTIVE):
        if any(status.phase in (ExplorationStatus.DRIVING, ExplorationStatus.TURNING) for status in driven):
            break
        rate.sleep()
    if options.errand:
        if not call(options.explorer, "pause"):
            return 1
        rospy.loginfo("the errand %s", "is done" if run_errand(options.errand) else "FAILED")
        if not call(options.explorer, "resume"):
            return 1

    explore.wait_for_result()
    result = explore.get_result()
    print(f"{result.end_reason}: {result.message}")
    print(f"{result.totals.distance_m:.1f} m driven, {result.totals.known_area_m2:.0f} m2 known, map: {result.map_file}")
    return 0 if result.success else 1


if __name__ == "__main__":
    sys.exit(main())
