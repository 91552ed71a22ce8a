#!/usr/bin/env python3
"""Prints one transform, as tf2_ros has it: look_up.py TARGET SOURCE."""
import sys

import rospy
import tf2_ros

rospy.init_node("look_up")
buffer = tf2_ros.Buffer()
listener = tf2_ros.TransformListener(buffer)
print(buffer.lookup_transform(sys.argv[1], sys.argv[2], rospy.Time(0), rospy.Duration(10)))
