"""`dmise detect`, sep and source-extractor on one frame, as lists of the same form.

A catalogue is a structured array: x, y [px from 0], length and width [px], snr, and flux in electrons by several measures.
sep and source-extractor filter with the Gaussian of the header's point spread, wider by a factor where asked, and take what
has 5 connected pixels above a threshold in units of the noise.
"""

import json
import pathlib
import re
import subprocess
import tempfile
import time

import numpy as np
from astropy.io import fits

import peer_frames
import referee

COLUMNS = ["x", "y", "length", "width", "snr", "auto_e", "aperture_e"]
LEAST_PIXELS = 5
MOST_HALF_PX = 15  # half the width of a filter of source-extractor
APERTURE_FWHM = 3.0  # diameter of the aperture in units of the point spread's FWHM; its share of a point's light is known


def catalogue(columns):
    """From {name: values}, those of COLUMNS that are missing NaN."""
    n = len(columns["x"])
    out = np.zeros(n, dtype=[(name, float) for name in COLUMNS])
    for name in COLUMNS:
        out[name] = columns.get(name, np.full(n, np.nan))
    return out


def kernel(fwhm_px):
    """Gaussian over odd squares of pixels, of unit sum."""
    half = min(int(np.ceil(1.5 * fwhm_px)), MOST_HALF_PX)
    axis = np.exp(-4 * np.log(2) * (np.arange(-half, half + 1) / fwhm_px) ** 2)
    grid = np.outer(axis, axis)
    return grid / grid.sum()


def aperture_share(header):
    """Share of a point's light in the aperture."""
    radius = APERTURE_FWHM * header["PSFFWHM"] / 2
    return 1 - np.exp(-radius**2 / (2 * peer_frames.sigma_px(header["PSFFWHM"]) ** 2))


def dmise(binary, path, *options):
    done = subprocess.run([binary, "detect", path, *options], capture_output=True, text=True)
    if done.returncode != 0:
        raise referee.Failure(f"dmise detect: {done.stderr.strip()}")
    found = [json.loads(line) for line in done.stdout.splitlines()]
    return catalogue({
        "x": np.array([d["x_px"] for d in found]), "y": np.array([d["y_px"] for d in found]),
        "length": np.array([d["length_px"] for d in found]), "width": np.zeros(len(found)),
        "snr": np.array([d["snr"] for d in found]), "auto_e": np.array([d["signal_e"] for d in found]),
        "aperture_e": np.array([d["signal_e"] for d in found])})


def with_sep(counts, header, threshold, wider=1.0, contrast=0.005, stack_px=10_000_000, light=True):
    """sep (SExtractor's methods as a library), with or without windowed places and light; returns the catalogue and the seconds of
    processor."""
    import sep
    sep.set_extract_pixstack(stack_px)
    sep.set_sub_object_limit(65536)
    data = np.ascontiguousarray(counts, dtype=np.float32)
    fwhm = header["PSFFWHM"]
    start = time.process_time()
    background = sep.Background(data, bw=64, bh=64)
    data = data - background.back()
    noise = background.rms()
    found = sep.extract(data, threshold, err=noise, minarea=LEAST_PIXELS, filter_kernel=kernel(wider * fwhm),
                        deblend_cont=contrast)
    local = noise[np.clip(np.rint(found["y"]), 0, None).astype(int), np.clip(np.rint(found["x"]), 0, None).astype(int)]
    shapes = {"length": np.sqrt(12) * found["a"], "width": np.sqrt(12) * found["b"],
              "snr": found["flux"] / (local * np.sqrt(found["npix"]))}
    if not light:
        return catalogue({"x": found["x"], "y": found["y"], **shapes}), time.process_time() - start
    # A window 1.2 times as wide as a point: of those tried the one with the least errors.
    window = np.full(len(found), 1.2 * peer_frames.sigma_px(fwhm))
    x, y, _ = sep.winpos(data, found["x"], found["y"], window)
    shape = found["a"], found["b"], np.clip(found["theta"], -np.pi / 2, np.pi / 2)
    kron, _ = sep.kron_radius(data, found["x"], found["y"], *shape, 6.0)
    auto, _, _ = sep.sum_ellipse(data, found["x"], found["y"], *shape, 2.5 * np.maximum(kron, 1.4), subpix=5)
    circle, _, _ = sep.sum_circle(data, x, y, APERTURE_FWHM * fwhm / 2, subpix=5)
    seconds = time.process_time() - start
    gain = header["GAIN"]
    return catalogue({"x": x, "y": y, **shapes, "auto_e": gain * auto, "aperture_e": gain * circle / aperture_share(header)}), seconds


SOURCE_EXTRACTOR_COLUMNS = ["XWIN_IMAGE", "YWIN_IMAGE", "A_IMAGE", "B_IMAGE", "FLUX_ISO", "FLUXERR_ISO", "FLUX_AUTO",
                            "FLUX_APER(1)"]


def with_source_extractor(path, header, threshold, wider=1.0, contrast=0.005, stack_px=10_000_000):
    """Debian's source-extractor (SExtractor 2); returns the catalogue, the seconds of processor and the peak in MB."""
    fwhm = header["PSFFWHM"]
    with tempfile.TemporaryDirectory() as name:
        directory = pathlib.Path(name)
        (directory / "columns").write_text("\n".join(SOURCE_EXTRACTOR_COLUMNS) + "\n")
        rows = "\n".join(" ".join(f"{v:.7f}" for v in row) for row in kernel(wider * fwhm))
        (directory / "filter").write_text("CONV NORM\n" + rows + "\n")
        settings = {
            "CATALOG_NAME": "sources.fits", "CATALOG_TYPE": "FITS_1.0", "PARAMETERS_NAME": "columns", "FILTER": "Y",
            "FILTER_NAME": "filter", "DETECT_MINAREA": LEAST_PIXELS, "DETECT_THRESH": threshold,
            "ANALYSIS_THRESH": threshold, "PHOT_APERTURES": f"{APERTURE_FWHM * fwhm:.4f}", "BACK_SIZE": 64,
            "DEBLEND_MINCONT": contrast, "GAIN": header["GAIN"], "SATUR_LEVEL": header["SATURATE"],
            "SEEING_FWHM": fwhm, "PIXEL_SCALE": 1, "WEIGHT_TYPE": "NONE", "VERBOSE_TYPE": "QUIET", "NTHREADS": 1,
            "MEMORY_OBJSTACK": 65000, "MEMORY_PIXSTACK": stack_px, "MEMORY_BUFSIZE": 4096}
        command = ["source-extractor", str(pathlib.Path(path).resolve()), "-c", "/dev/null"]
        for key, value in settings.items():
            command += [f"-{key}", str(value)]
        seconds, peak_mb = cost_of(command, directory)
        table = fits.getdata(directory / "sources.fits", 1)
    gain = header["GAIN"]
    error = np.maximum(table["FLUXERR_ISO"], 1e-9)
    return catalogue({
        "x": table["XWIN_IMAGE"] - 1.0, "y": table["YWIN_IMAGE"] - 1.0, "length": np.sqrt(12) * table["A_IMAGE"],
        "width": np.sqrt(12) * table["B_IMAGE"], "snr": table["FLUX_ISO"] / error, "auto_e": gain * table["FLUX_AUTO"],
        "aperture_e": gain * np.ravel(table["FLUX_APER"]) / aperture_share(header)}), seconds, peak_mb


# The child says what it took: its parent's peak memory would count where both are one process.
COST = """
import os, resource, subprocess, sys
done = subprocess.run(sys.argv[1:], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
used = resource.getrusage(resource.RUSAGE_CHILDREN)
print(used.ru_utime + used.ru_stime, used.ru_maxrss / 1024)
sys.stderr.write(done.stderr)
sys.exit(done.returncode)
"""


def cost_of(command, directory="."):
    """(seconds of processor, peak memory in MB) of a command."""
    done = subprocess.run(["/usr/bin/python3", "-S", "-c", COST, *map(str, command)], cwd=directory, capture_output=True,
                          text=True)
    if done.returncode != 0:
        raise referee.Failure(f"{command[0]}: {done.stderr.strip()[-300:]}")
    seconds, peak_mb = map(float, done.stdout.split())
    return seconds, peak_mb


def versions():
    """Versions of the others, and of GalSim."""
    import galsim
    import sep
    said = subprocess.run(["source-extractor", "--version"], capture_output=True, text=True).stdout
    number = re.search(r"[0-9][0-9.]*", said) or ["of an unknown version"]
    return f"sep {sep.__version__}, source-extractor {number[0]}, galsim {galsim.__version__}"


def memory_mb(key):
    """VmRSS or VmHWM of this process."""
    line = next(line for line in open("/proc/self/status") if line.startswith(key))
    return float(line.split()[1]) / 1024


def main(path, threshold):
    """Prints what sep took in this process: seconds, and MB beyond Python, the frame included."""
    with fits.open(path) as hdus:
        hdu = next(h for h in hdus if h.data is not None)
        counts, header = hdu.data.astype(np.float32), hdu.header
    with_sep(counts[:64, :64], header, threshold, stack_px=1_000_000)
    before_mb = memory_mb("VmRSS") - counts.nbytes / 2**20
    pathlib.Path("/proc/self/clear_refs").write_text("5")  # proc(5): resets the peak
    _, seconds = with_sep(counts, header, threshold, stack_px=1_000_000)
    print(seconds, memory_mb("VmHWM") - before_mb)


if __name__ == "__main__":
    import sys
    main(sys.argv[1], float(sys.argv[2]))
