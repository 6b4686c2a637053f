#!/usr/bin/env python3
"""Pixels of stars before a camera that points elsewhere than it is told to, by astropy's spherical trigonometry: the figures
of tests/pipeline/test_instrument_errors.cpp. Prints the commanded pixel and the true one of each star."""
import astropy.units as u
import numpy as np
from astropy.coordinates import SkyCoord

FOCAL_PX, CENTRE = 1e4, (599.5, 499.5)  # columns 1200, rows 1000
COMMANDED = SkyCoord(30 * u.deg, 40 * u.deg)
STARS = [(30.0, 40.0), (31.2, 40.9), (28.9, 38.8), (32.4, 39.1)]


def pixel(star, boresight, up):
    """Gnomonic; `up`: position angle of the image's up, north through east, which is to the left of north."""
    away, angle = boresight.separation(star).rad, boresight.position_angle(star).rad - up
    return CENTRE[0] - FOCAL_PX * np.tan(away) * np.sin(angle), CENTRE[1] - FOCAL_PX * np.tan(away) * np.cos(angle)


def displaced(x_deg, y_deg, roll_deg):
    """The boresight goes x to the right (west) and y down (south) on a great circle, whose direction the image keeps; then the
    image turns clockwise, as the camera sees it, so that the position angle of its up falls."""
    away, angle = np.hypot(x_deg, y_deg) * u.deg, np.arctan2(-x_deg, -y_deg) * u.rad
    if away == 0:
        return COMMANDED, -np.radians(roll_deg)
    boresight = COMMANDED.directional_offset_by(angle, away)
    onward = boresight.position_angle(COMMANDED) + 180 * u.deg
    return boresight, (onward - angle).to_value(u.rad) - np.radians(roll_deg)


if __name__ == "__main__":
    for x, y, roll in [(1.2, -0.7, 0.0), (0.0, 0.0, 5.0), (-1.0, 1.5, 5.0)]:
        print(f"bias_deg: [{x}, {y}, {roll}]")
        for ra, dec in STARS:
            star = SkyCoord(ra * u.deg, dec * u.deg)
            told, truly = pixel(star, COMMANDED, 0.0), pixel(star, *displaced(x, y, roll))
            print(f"  {{{ra}, {dec}, {told[0]:.5f}, {told[1]:.5f}, {truly[0]:.5f}, {truly[1]:.5f}}},")
