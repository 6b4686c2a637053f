#!/usr/bin/python3
"""A node of a run in Python: takes part in the clock and counts the detections of each tick.

Usage: PYTHONPATH=build/python node.py MASTER_ADDRESS NAME TOPIC...
NAME must be one of those that the time-master expects. docs/wire.md explains every step.
"""
import sys

import dmise

try:
    for tick in dmise.Node(sys.argv[1], sys.argv[2], sys.argv[3:]):
        print("tick", tick.number, len(tick.records), "detections", flush=True)
except (dmise.Refused, dmise.NoAnswer, dmise.RunFailed) as error:
    sys.exit(str(error))
