"""Simulated objects in frames of a real camera: their light with its noise, and their labels.

    made = dmise.inject(image, header, "objects.yaml", zero_point_mag=24.1, gain_e_per_dn=1.6)
    made.image, made.labels["start_x_px"], made.labels["snr"]
"""
from __future__ import annotations

import json
import math
import os
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from .engine import core, streams
from .errors import EngineError, InputError
from .scenario_text import Scenario, seed_of, source_of
from .simulation import SimulatedFrame
from .solution import file_of_frame
from .tables import Table

Array = npt.NDArray[Any]
GRID = 9           # places along each axis where geometries are compared
CLOSE_PX = 1e-3    # between geometries, of what a camera's attitude and focal length can do
MAX_ROUNDS = 6
MAX_ELECTRONS = 1e15  # in a pixel: their number is drawn as one of 64 bits
LABELS = [("catalogue_number", np.int64), ("start_x_px", float), ("start_y_px", float), ("end_x_px", float),
          ("end_y_px", float), ("x_px", float), ("y_px", float), ("signal_e", float), ("magnitude", float), ("snr", float),
          ("label", np.int64)]


@dataclass
class Injected:
    """A frame with objects that were not there.

    image    as it was given, with their light: its shape and type
    labels   a row for each object with light in the frame: name, catalogue_number, ends of its path and middle of its light,
             signal_e (expected electrons), magnitude, snr (of the best linear filter), label (its number in `mask`)
    light    expected electrons of all objects, rows x columns
    mask     rows x columns: the label of the object whose light is there, else 0
    facts    what was used: zero_point_mag, gain_e_per_dn, psf_fwhm_px, noise_e, saturation_dn, and geometry_px, the largest
             difference between the frame's WCS and that of the simulated camera; missing, assumed: as of `detect`
    """
    image: Array
    labels: Table
    light: npt.NDArray[np.float32]
    mask: npt.NDArray[np.uint16]
    facts: dict[str, Any]


def inject(image: Any, header: Any, scenario: Scenario, *, seed: int = 1,
           sensor: str = "", zero_point_mag: float | None = None, gain_e_per_dn: float | None = None,
           psf_fwhm_px: float | None = None, saturation_dn: float | None = None, tracking: str | None = None,
           catalogue: str | os.PathLike[str] = "kstars", blind: bool = False, threads: int = 1) -> Injected:
    """Draws the objects of a scenario into a frame of a real camera, as they were at its time from the scenario's site.

    image, header   as of `detect`
    scenario        with objects, and a sensor that tells site, band and lens; the frame tells time, exposure, pointing,
                    scale and blur. Distributions are drawn by the seed
    seed            of the light's noise and of what is drawn
    sensor          of a scenario with several
    zero_point_mag  V of a source of the Sun's colour that gives 1 e-/s; by default that of the frame's stars
    gain_e_per_dn, psf_fwhm_px, saturation_dn  by default as of `detect`
    tracking        "sidereal" or "fixed"; by default as the frame's stars tell
    catalogue, blind, threads  as of `detect`

    Raises `InputError` for what neither the frame nor an argument tells.
    """
    seed = seed_of(seed) or 0
    found = core.calibrate(file_of_frame(image, header), "image", os.fspath(catalogue), blind, threads)
    pixels = image.counts if isinstance(image, SimulatedFrame) else image if isinstance(image, np.ma.MaskedArray) else np.asarray(image)
    camera = _Camera(found, pixels, {"zero_point_mag": zero_point_mag, "gain_e_per_dn": gain_e_per_dn,
                                     "psf_fwhm_px": psf_fwhm_px, "saturation_dn": saturation_dn}, tracking)
    made, worst_px = camera.simulate(_drawn(scenario, seed), sensor, threads)
    factor = 10.0 ** (0.4 * (camera.zero_point_mag - made.zero_point_mag))
    objects = camera.turned(made.objects())
    if factor * float(objects.max()) > MAX_ELECTRONS:
        raise InputError(f"zero_point_mag: gives a pixel more than {MAX_ELECTRONS:g} electrons, got {camera.zero_point_mag}")
    light = np.asarray(objects * np.float32(factor))
    mask = np.ascontiguousarray(camera.turned(made.labels()))
    labels, mask = _labels([json.loads(line) for line in made.truths()], light, mask, camera, factor)
    return Injected(_exposed(pixels, light, camera, np.random.default_rng([seed, 0x1a])), labels, light, mask,
                    camera.facts | {"geometry_px": worst_px})


def _drawn(scenario: Scenario, seed: int) -> Any:
    text, name = source_of(scenario)
    return core.Simulation.drawn_of_file(name, seed) if text is None else core.Simulation.drawn_of_text(text, name, seed)


class _Camera:
    """What is known of the camera of a frame."""

    def __init__(self, found: Any, pixels: Array, stated: dict[str, float | None], tracking: str | None) -> None:
        _require_known(found, stated, tracking)
        self.found, (self.rows, self.columns) = found, pixels.shape
        if min(pixels.shape) < 2:
            raise InputError(f"image: must have two rows and two columns or more, got shape {pixels.shape}")
        step, zero = found.count_step, found.count_zero  # what the engine reads as a count of 1, and as none
        self.gain = float(stated["gain_e_per_dn"] or found.gain_e_per_dn / step)
        e_per_found_e = self.gain * step / found.gain_e_per_dn
        magnitude = stated["zero_point_mag"]
        self.extinction = magnitude is None and "extinct" not in found.unknown.split()
        self.zero_point_mag = float(found.zero_point_mag + 2.5 * math.log10(e_per_found_e) if magnitude is None else magnitude)
        self.noise_e = found.noise_e * e_per_found_e
        self.psf_fwhm_px = float(stated["psf_fwhm_px"] or found.psf_fwhm_px)
        clipped = 0.0 < found.saturation_dn < 65535.0
        self.saturation = stated["saturation_dn"] or (zero + step * found.saturation_dn if clipped else math.inf)
        self.sidereal = tracking != "fixed" if tracking else found.mount != "fixed"
        self.mirrored = False

    @property
    def facts(self) -> dict[str, Any]:
        return {"zero_point_mag": self.zero_point_mag, "gain_e_per_dn": self.gain, "psf_fwhm_px": self.psf_fwhm_px,
                "noise_e": self.noise_e, "saturation_dn": self.saturation, "tracking": "sidereal" if self.sidereal else "fixed",
                "missing": self.found.missing, "assumed": self.found.assumed}

    def turned(self, image: Array) -> Array:
        """An image of the simulated camera in the order of the frame's rows."""
        return image[::-1] if self.mirrored else image

    def simulate(self, simulation: Any, sensor: str, threads: int) -> tuple[Any, float]:
        """The exposure of a simulated camera that sees the sky as the frame's WCS does, and how far it is off [px]."""
        x, y = (axis.ravel() for axis in np.meshgrid(np.linspace(0, self.columns - 1, GRID), np.linspace(0, self.rows - 1, GRID)))
        sky = self.found.wcs.directions(x.tolist(), y.tolist())
        like = self._first_guess()
        like.sensor = sensor
        wanted = np.stack([x, self.rows - 1 - y if self.mirrored else y], axis=1)
        for _ in range(MAX_ROUNDS):
            made = _only_frame(simulation.like(like), threads)
            away = np.asarray(made.wcs.pixels(sky.tolist())) - wanted
            if not np.isfinite(away).all():
                raise EngineError("image: the scenario's lens does not image the field of the frame")
            blur = self.psf_fwhm_px ** 2 - made.psf_fwhm_px ** 2
            like.psf_fwhm_px = math.sqrt(max(0.0, like.psf_fwhm_px ** 2 + blur))
            if self._corrected(like, made, wanted, away) < CLOSE_PX and abs(blur) < 1e-3:
                break
        return made, float(np.hypot(*away.T).max())

    def _first_guess(self) -> Any:
        """By the WCS around the middle of the frame."""
        x, y = (self.columns - 1) / 2, (self.rows - 1) / 2
        middle, right, down = self.found.wcs.directions([x, x + 1, x], [y, y, y + 1])
        self.mirrored = bool(np.dot(np.cross(right - middle, down - middle), middle) < 0.0)
        up = middle - down if not self.mirrored else down - middle
        like = core.Likeness()
        like.start_utc, like.exposure_s = self.found.start_utc, self.found.exposure_s
        like.columns, like.rows = self.columns, self.rows
        like.focal_length_px = 1.0 / math.sqrt(np.linalg.norm(np.cross(right - middle, down - middle)))
        like.sidereal, like.extinction, like.psf_fwhm_px = self.sidereal, self.extinction, self.psf_fwhm_px
        like.guided = self.sidereal and not self.found.simulated
        ra, _ = _point(like, middle)
        east = np.array([-math.sin(ra), math.cos(ra), 0.0])
        like.roll_deg = math.degrees(math.atan2(float(up @ east), float(up @ np.cross(middle, east))))
        return like

    def _corrected(self, like: Any, made: Any, wanted: Array, away: Array) -> float:
        """Turns and scales the simulated camera by the mean difference. Returns how far that moves an image [px]."""
        centre = np.array([(self.columns - 1) / 2, (self.rows - 1) / 2])
        q = (wanted - centre) @ [1, 1j]
        p = (wanted + away - centre) @ [1, 1j]
        shift = np.mean(p) - np.mean(q)
        growth = np.vdot(q - q.mean(), p - p.mean()) / max(np.vdot(q - q.mean(), q - q.mean()).real, 1e-12)
        like.focal_length_px /= abs(growth)
        like.roll_deg = (like.roll_deg - math.degrees(np.angle(growth)) + 180.0) % 360.0 - 180.0
        to = made.wcs.directions([centre[0] + shift.real, centre[0]], [centre[1] + shift.imag, centre[1]])
        ra, dec = math.radians(like.ra_deg), math.radians(like.dec_deg)
        _point(like, np.array([math.cos(dec) * math.cos(ra), math.cos(dec) * math.sin(ra), math.sin(dec)]) + to[0] - to[1])
        return float(abs(shift) + abs(growth - 1.0) * np.abs(q).max())


def _require_known(found: Any, stated: dict[str, float | None], tracking: str | None) -> None:
    """Raises InputError for what neither the frame nor an argument tells, and for an argument that is impossible."""
    for name, value in stated.items():
        signed = name == "zero_point_mag"
        if value is None:
            continue
        if not math.isfinite(value) or (value <= 0.0 and not signed):
            raise InputError(f"{name}: must be a number{'' if signed else ' > 0'}, got {value}")
        if not (abs(value) <= 100.0 if signed else 1e-30 <= value <= 1e30):
            raise InputError(f"{name}: must be in {'-100..100' if signed else '1e-30..1e30'}, got {value}")
    if tracking not in (None, "sidereal", "fixed"):
        raise InputError(f'tracking: must be "sidereal" or "fixed", got {tracking!r}')
    unknown = found.unknown.split()
    for word, reason in (("time", "image: the time is not known; DATE-OBS tells it"),
                         ("exposure", "image: the exposure is not known; EXPTIME tells it"),
                         ("pointing", "image: the pointing is not known; a WCS tells it, or RA and DEC, or blind=True finds it")):
        if word in unknown:
            raise InputError(reason)
    for word, name, reason in (("gain", "gain_e_per_dn", "neither the header nor the sky's noise tells it"),
                               ("zero", "zero_point_mag", "no stars of the catalogue tell it")):
        if word in unknown and stated[name] is None:
            raise InputError(f"{name}: is not known; {reason}")


def _point(like: Any, direction: Array) -> tuple[float, float]:
    """Points at a direction. Returns its right ascension and declination [rad]."""
    x, y, z = direction / np.linalg.norm(direction)
    ra, dec = math.atan2(y, x), math.asin(z)
    like.ra_deg, like.dec_deg = math.degrees(ra), math.degrees(dec)
    return ra, dec


def _only_frame(simulation: Any, threads: int) -> Any:
    stream = simulation.frames([], threads, True)
    streams.add(stream)
    try:
        return stream.next()
    finally:
        stream.stop()


def _labels(truths: list[dict[str, Any]], light: Array, mask: Array, camera: _Camera,
            factor: float) -> tuple[Table, npt.NDArray[np.uint16]]:
    """Labels of the objects with light, numbered from 1 in the mask."""
    lit = [k for k, truth in enumerate(truths) if truth["in_frame"]]
    number = np.zeros(len(truths) + 1, np.uint16)
    number[[k + 1 for k in lit]] = np.arange(1, len(lit) + 1)
    mask = number[mask]
    names = [truths[k]["name"] for k in lit]
    table = np.zeros(len(lit), [("name", f"U{max([1, *map(len, names)])}"), *LABELS])
    table["name"] = names
    snr2 = light / (camera.noise_e ** 2 / np.maximum(light, 1e-30) + 1.0)  # s^2 / (sigma^2 + s)
    for row, k in zip(table, lit):
        truth = truths[k]
        row["catalogue_number"], row["magnitude"] = truth["catalogue_number"], truth["true_magnitude"]
        row["signal_e"] = truth["rendered_signal_e"] * factor
        for key, of_truth in (("start_", "start_px"), ("end_", "end_px"), ("", "rendered_px")):
            x, y = truth[of_truth]
            row[f"{key}x_px"], row[f"{key}y_px"] = x, camera.rows - 1 - y if camera.mirrored else y
        row["label"] = number[k + 1]
    sums = np.bincount(mask.ravel(), snr2.ravel().astype(float), len(lit) + 1)
    table["snr"] = np.sqrt(sums[1:])
    return table.view(Table), mask


def _highest(kind: np.dtype[Any]) -> float:
    """The largest number of 64 bits that a type holds."""
    if np.issubdtype(kind, np.floating):
        return float(min(np.finfo(kind).max, np.finfo(float).max))
    largest = float(np.iinfo(kind).max)
    return largest if int(largest) <= np.iinfo(kind).max else float(np.nextafter(largest, 0.0))


def _exposed(pixels: Array, light: Array, camera: _Camera, random: np.random.Generator) -> Array:
    """The image with light, whose electrons arrive by chance, up to saturation."""
    lit = np.isfinite(np.ma.getdata(pixels)) & ~np.ma.getmaskarray(pixels) & (light > 0.0)
    before, added = pixels[lit], random.poisson(light[lit].astype(float)) / camera.gain
    highest = np.minimum(np.maximum(before.astype(float), camera.saturation), _highest(pixels.dtype))
    if np.issubdtype(pixels.dtype, np.integer):
        # The part of a count that the camera's rounding has left is unknown: uniform.
        added = np.floor(added + random.uniform(size=added.size))
    image = pixels.copy()
    image[lit] = np.minimum(before + added, highest).astype(pixels.dtype)
    return image
