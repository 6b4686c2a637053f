#!/usr/bin/env python3
"""Writes launch/scenarios/inspector.oem: the orbit of `inspector` in inspector.yaml, 0.15 deg ahead.

Circular, so that position and velocity have a closed form; seven lines a minute apart.
"""
import datetime
import math

GM = 3.986004415e14  # m^3/s^2, IERS Conventions 2010
A = 7_178_137.0  # m
INCLINATION = math.radians(98.6)
AHEAD = math.radians(0.15)
START = datetime.datetime(2018, 1, 21, 0, 15)

print("""CCSDS_OEM_VERS = 2.0
CREATION_DATE = 2018-01-20T00:00:00
ORIGINATOR = DMISE
META_START
OBJECT_NAME = PROBE
OBJECT_ID = 2018-999A
CENTER_NAME = EARTH
REF_FRAME = GCRF
TIME_SYSTEM = UTC
START_TIME = 2018-01-21T00:13:00
STOP_TIME = 2018-01-21T00:19:00
INTERPOLATION = HERMITE
INTERPOLATION_DEGREE = 7
META_STOP""")
rate = math.sqrt(GM / A**3)
for k in range(-2, 5):
    u = AHEAD + rate * 60 * k
    c, s = math.cos(u), math.sin(u)
    ci, si = math.cos(INCLINATION), math.sin(INCLINATION)
    speed = rate * A / 1e3
    time = (START + datetime.timedelta(minutes=k)).isoformat()
    print(f"{time} {A/1e3*c:.9f} {A/1e3*s*ci:.9f} {A/1e3*s*si:.9f} "
          f"{-speed*s:.12f} {speed*c*ci:.12f} {speed*c*si:.12f}")
