#!/usr/bin/env python3
"""Prints how many messages of each topic of a bag rosbag can read, with all their fields."""
import sys

import rosbag

counts = {}
for topic, message, _ in rosbag.Bag(sys.argv[1]).read_messages():
    assert str(message), topic
    counts[topic] = counts.get(topic, 0) + 1
print(" ".join("%s=%d" % pair for pair in sorted(counts.items())))
