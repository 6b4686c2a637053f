"""project_with_opencv.py MODEL FILE: prints where OpenCV images directions, in focal lengths.

MODEL: fisheye (k1 k2 k3 k4) or pinhole (k1 k2 p1 p2 k3). FILE: the coefficients in the first line,
then a direction "x y z" in each."""

import sys

import cv2
import numpy as np

with open(sys.argv[2]) as file:
    coefficients = np.array([float(word) for word in file.readline().split()])
    directions = np.loadtxt(file, ndmin=2).reshape(-1, 1, 3)
still = np.zeros(3)
if sys.argv[1] == "fisheye":
    places, _ = cv2.fisheye.projectPoints(directions, still, still, np.eye(3), coefficients)
else:
    places, _ = cv2.projectPoints(directions, still, still, np.eye(3), coefficients)
for x, y in places.reshape(-1, 2):
    print(f"{x:.17g} {y:.17g}")
