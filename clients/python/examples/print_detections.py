#!/usr/bin/env python3
"""Prints every detection of a run: print_detections.py tcp://HOST:PORT (needs the package dmise)."""
import sys

import dmise

for d in dmise.subscribe(sys.argv[1], "detection/"):
    print(d.id, d.time_utc.isoformat(), d.ra_rad, d.dec_rad, "rad", d.magnitude, d.band, flush=True)
