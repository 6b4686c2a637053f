#!/usr/bin/env python3
"""Writes bench/validation/hosek_wilkie.inc: luminance of the clear day sky [cd/m2] by Hosek & Wilkie 2012 (ACM
Trans. Graph. 31, 95) as SatSim 0.27.1 computes it. Usage: hosek_wilkie.py > bench/validation/hosek_wilkie.inc
`hosek_wilkie.py plane` prints how much light that sky sends down, over sunlight, and how much molecules scatter in all."""
import importlib.util
import pathlib
import sys

import numpy as np


def model():
    """SatSim's file alone, without what the rest of SatSim needs."""
    satsim = pathlib.Path(importlib.util.find_spec("satsim").origin).parent
    spec = importlib.util.spec_from_file_location("hosek_wilkie_model", satsim / "background" / "hosek_wilkie.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


TURBIDITY, ALBEDO, SUNLIGHT_LX = 2.5, 0.15, 133.1e3
DIRECTIONS_DEG = [(90, 0), (60, 60), (60, 180), (45, 90), (30, 45), (30, 180), (20, 100), (15, 135)]


def angle_from_sun_deg(sun_deg, altitude_rad, azimuth_rad):
    sun = np.radians(sun_deg)
    cosine = np.sin(altitude_rad) * np.sin(sun) + np.cos(altitude_rad) * np.cos(sun) * np.cos(azimuth_rad)
    return np.degrees(np.arccos(np.clip(cosine, -1, 1)))


def light_of_a_plane():
    """Over black ground, by turbidity and the Sun's altitude. Turbidity 1 is air without haze, of a depth of 0.0973 at 550 nm."""
    hosek_wilkie = model()
    sines, azimuths = (np.arange(60) + 0.5) / 60, (np.arange(36) + 0.5) * np.pi / 36
    for turbidity in (1, 2.5):
        for sun in (20, 35, 50, 70):
            down = sum(sine * hosek_wilkie.hosek_wilkie_luminance(
                90 - np.degrees(np.arcsin(sine)), 90 - sun, angle_from_sun_deg(sun, np.arcsin(sine), azimuth), turbidity, 0.0)
                for sine in sines for azimuth in azimuths) * 2 * np.pi / (60 * 36) / SUNLIGHT_LX
            height = np.sin(np.radians(sun))
            print(f"turbidity {turbidity}, Sun at {sun} deg: {down:.4f} down, {height * -np.expm1(-0.0973 / height):.4f} scattered by molecules")


def main():
    hosek_wilkie = model()
    print("// Made by tests/reference/hosek_wilkie.py with SatSim 0.27.1, turbidity 2.5, albedo 0.15.\n"
          "// {altitude of the Sun, altitude and azimuth from the Sun [deg], luminance [cd/m2]}")
    for sun in (10, 20, 35, 50, 70):
        for alt, az in DIRECTIONS_DEG:
            angle = angle_from_sun_deg(sun, *np.radians((alt, az)))
            luminance = hosek_wilkie.hosek_wilkie_luminance(90 - alt, 90 - sun, angle, TURBIDITY, ALBEDO)
            print(f"{{{{{sun}, {alt}, {az}}}, {luminance:.1f}}},")


if __name__ == "__main__":
    light_of_a_plane() if sys.argv[1:] == ["plane"] else main()
