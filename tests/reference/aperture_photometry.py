#!/usr/bin/python3
"""photutils measures the frames that `dmise discriminate` measured: the same light, errors and background.

    aperture_photometry.py DMISE

A window about the two objects of launch/scenarios/paper/space-imager.yaml, four exposures of each band. photutils sums by the
exact area of pixels in the circle, and clips the ring by astropy's SigmaClip.
"""

import json
import pathlib
import subprocess
import tempfile

import numpy as np
import yaml
from astropy.io import fits
from astropy.stats import SigmaClip

import referee

RADIUS_PX, INNER_PX, OUTER_PX = 4.0, 8.0, 16.0


def window(folder):
    """The scenario with cameras of 256 x 768 pixels."""
    scenarios = referee.SOURCE / "launch/scenarios/paper"
    scenario = yaml.load((scenarios / "space-imager.yaml").read_text(), yaml.BaseLoader)
    scenario["simulation"] |= {"duration_s": 6, "tick_s": 6}
    for thing in scenario["objects"]:
        if "geometry" in thing:
            thing["geometry"]["materials"] = str(scenarios / "cells.yaml")
    for sensor in scenario["sensors"]:
        camera = yaml.load((referee.SOURCE / f"launch/cameras/{sensor['camera']}.yaml").read_text(), yaml.BaseLoader)
        camera["optics"] |= {"columns": 256, "rows": 768}
        (folder / f"{sensor['name']}.yaml").write_text(json.dumps(camera))
        sensor["camera"] = f"{sensor['name']}.yaml"
    (folder / "scenario.yaml").write_text(json.dumps(scenario))
    return scenarios / "cells.yaml"


def electrons(path):
    with fits.open(path) as file:
        hdu = next(h for h in file if h.data is not None)
        return (hdu.data.astype(float) - hdu.header["BIASLVL"]) * hdu.header["GAIN"]


def judge(dmise):
    try:
        from photutils.aperture import ApertureStats, CircularAnnulus, CircularAperture, aperture_photometry
    except ImportError as missing:
        raise referee.Missing(f"photutils: {missing}") from None
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        cells = window(folder)
        dmise = str(pathlib.Path(dmise).resolve())
        subprocess.run([dmise, "run", "scenario.yaml", "--out", "out"], cwd=folder, check=True, stdout=subprocess.DEVNULL,
                       stderr=subprocess.DEVNULL)
        report = json.loads(subprocess.run([dmise, "discriminate", "out", "--materials", cells, "--json"], cwd=folder,
                                           check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL).stdout)
        bands = [band["sensor"] for band in report["bands"]]
        light = {key: 0.0 for key in ("flux", "background", "sigma")}
        count = 0
        for sample in report["samples"]:
            for band, ours in zip(bands, sample["bands"]):
                image = electrons(folder / "out" / band / f"frame-{sample['frame']:06}.fits")
                at = (ours["x_px"], ours["y_px"])
                ring = ApertureStats(image, CircularAnnulus(at, INNER_PX, OUTER_PX), sum_method="center",
                                     sigma_clip=SigmaClip(sigma=3, maxiters=5))
                circle = CircularAperture(at, RADIUS_PX)
                error = np.full(image.shape, float(ring.std))
                sums = aperture_photometry(image, circle, error=error, method="exact")
                flux = float(sums["aperture_sum"][0]) - float(ring.mean) * circle.area
                light["flux"] = max(light["flux"], abs(ours["flux_e"] / flux - 1))
                light["background"] = max(light["background"], abs(ours["background_e"] - float(ring.mean)))
                # photutils weighs variances by area, not by its square; the difference is in the circle's edge.
                sigma = np.sqrt(float(sums["aperture_sum_err"][0]) ** 2 + max(flux, 0.0))
                light["sigma"] = max(light["sigma"], abs(ours["sigma_e"] / sigma - 1))
                count += 1
        print(f"{count} measurements: flux to {light['flux']:.1e}, background to {light['background']:.1e} e-, "
              f"sigma to {light['sigma']:.3f}")
        if count < 16:
            raise referee.Failure(f"only {count} measurements")
        if light["flux"] > 1e-6 or light["background"] > 1e-6 or light["sigma"] > 0.06:
            raise referee.Failure("photutils has other figures")


if __name__ == "__main__":
    import sys

    referee.main(judge, *sys.argv[1:])
