#!/usr/bin/env python3
"""A robot's stack of real parts: rospy, tf2_ros broadcasters and an actionlib
SimpleActionServer as move_base. The robot stands where its last goal was; the map of two
rooms shows what lies within 2.5 m of where it has been."""
import math

import actionlib
import rospy
import tf2_ros
from geometry_msgs.msg import Quaternion, TransformStamped, Twist
from move_base_msgs.msg import MoveBaseAction, MoveBaseFeedback
from nav_msgs.msg import OccupancyGrid

WIDTH, HEIGHT, RESOLUTION, REACH = 160, 70, 0.05, 2.5


def is_wall(x, y):
    outer = x < 4 or y < 4 or x >= WIDTH - 4 or y >= HEIGHT - 4
    return outer or (78 <= x < 82 and not 25 <= y < 47)


class Stack:
    def __init__(self):
        self.x, self.y, self.yaw, self.turning = 2.0, 1.7, 0.0, 0.0
        self.known = [-1] * (WIDTH * HEIGHT)
        self.dynamic = tf2_ros.TransformBroadcaster()
        self.static = tf2_ros.StaticTransformBroadcaster()
        self.static.sendTransform(self.transform("base_footprint", "base_link", 0, 0, 0))
        self.maps = rospy.Publisher("map", OccupancyGrid, queue_size=1, latch=True)
        rospy.Subscriber("cmd_vel", Twist, self.on_twist)
        self.server = actionlib.SimpleActionServer("move_base", MoveBaseAction, self.drive, False)
        self.server.start()
        rospy.Timer(rospy.Duration(0.05), self.tick)
        rospy.Timer(rospy.Duration(0.5), self.publish_map)

    @staticmethod
    def transform(parent, child, x, y, yaw):
        message = TransformStamped()
        message.header.stamp = rospy.Time.now()
        message.header.frame_id, message.child_frame_id = parent, child
        message.transform.translation.x, message.transform.translation.y = x, y
        message.transform.rotation = Quaternion(0, 0, math.sin(yaw / 2), math.cos(yaw / 2))
        return message

    def on_twist(self, twist):
        self.turning = twist.angular.z

    def tick(self, _):
        self.yaw += 0.05 * self.turning
        self.dynamic.sendTransform([
            self.transform("map", "odom", 0.5, 0, 0),
            self.transform("odom", "base_footprint", self.x - 0.5, self.y, self.yaw),
        ])

    def drive(self, goal):
        target = goal.target_pose.pose
        for _ in range(3):
            if self.server.is_preempt_requested():
                self.server.set_preempted()
                return
            self.server.publish_feedback(MoveBaseFeedback())
            rospy.sleep(0.1)
        self.x, self.y = target.position.x, target.position.y
        self.yaw = 2 * math.atan2(target.orientation.z, target.orientation.w)
        rospy.sleep(0.1)
        self.server.set_succeeded()

    def publish_map(self, _):
        cells = int(REACH / RESOLUTION)
        cx, cy = int(self.x / RESOLUTION), int(self.y / RESOLUTION)
        for y in range(max(0, cy - cells), min(HEIGHT, cy + cells)):
            for x in range(max(0, cx - cells), min(WIDTH, cx + cells)):
                same_room = (x < 82) == (cx < 80) or 25 <= y < 47
                if same_room and (x - cx) ** 2 + (y - cy) ** 2 <= cells ** 2:
                    self.known[y * WIDTH + x] = 100 if is_wall(x, y) else 0
        grid = OccupancyGrid()
        grid.header.frame_id, grid.header.stamp = "map", rospy.Time.now()
        grid.info.resolution, grid.info.width, grid.info.height = RESOLUTION, WIDTH, HEIGHT
        grid.info.origin.orientation.w = 1.0
        grid.data = self.known
        self.maps.publish(grid)


if __name__ == "__main__":
    rospy.init_node("stack")
    Stack()
    rospy.spin()
