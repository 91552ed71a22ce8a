#!/usr/bin/env python3
"""Prints one transform, as tf2_ros has it: look_up.py TARGET SOURCE.

Waits for it by the clock on the wall: simulated time may run many times as fast, and a busy
machine needs its seconds to connect the listener."""
import sys
import time

import rospy
import tf2_ros

target, source = sys.argv[1:3]
rospy.init_node("look_up")
buffer = tf2_ros.Buffer()
listener = tf2_ros.TransformListener(buffer)
deadline = time.monotonic() + 30
while not buffer.can_transform(target, source, rospy.Time(0)) and time.monotonic() < deadline:
    time.sleep(0.05)
print(buffer.lookup_transform(target, source, rospy.Time(0)))
