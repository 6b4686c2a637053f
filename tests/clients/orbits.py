"""Orbits and lines of sight of the Python package beside analytic facts, scipy's integrator and ERFA's pole.

    orbits.py
"""

import datetime
import math
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests/system"), str(ROOT / "build/python")]
from harness import Failure, check  # noqa: E402

try:
    import numpy as np
    import scipy.integrate
    import scipy.stats
except ImportError as missing:
    print(f"skipped: {missing.name} is not installed (./dmise setup --tests)")
    sys.exit(77)
from dmise.dynamics import (EARTH_RADIUS_M, GM_M3_PER_S2, J2, acceleration, apparent_direction, pole_of,  # noqa: E402
                            propagate)
from dmise.orbit_fit import fit_orbit, is_bound, triangulate  # noqa: E402
from dmise.sight import LineOfSight, direction_of  # noqa: E402

ARCSEC = math.pi / 648000.0
NORTH = np.array([0.0, 0.0, 1.0])
INCLINATION = math.radians(60.0)
LEO = np.array([7.2e6, 0.0, 0.0, 0.0, 7440.0 * math.cos(INCLINATION), 7440.0 * math.sin(INCLINATION)])


def potential(position):
    """The Earth's potential by its mass and J2 (Vallado, Fundamentals of Astrodynamics, 8.6)."""
    r = np.linalg.norm(position)
    return GM_M3_PER_S2 / r * (1.0 - J2 * (EARTH_RADIUS_M / r) ** 2 * (3.0 * (position[2] / r) ** 2 - 1.0) / 2.0)


def accelerations_are_gradients():
    worst = 0.0
    for seed in range(20):
        position = np.random.default_rng(seed).normal(size=3) * 5e6 + [6e6, 0, 0]
        gradient = [(potential(position + d) - potential(position - d)) / 2.0 for d in np.diag([1.0] * 3)]
        error = np.linalg.norm(acceleration(position[:, None], NORTH)[:, 0] - gradient) / np.linalg.norm(gradient)
        worst = max(worst, float(error))
    check(worst < 1e-7, f"accelerations are gradients of the potential, within {worst:.1e}")


def steps_are_short_enough():
    theirs = scipy.integrate.solve_ivp(
        lambda _, y: np.concatenate([y[3:], acceleration(y[:3, None], NORTH)[:, 0]]), (0.0, 6000.0), LEO, method="DOP853",
        rtol=1e-13, atol=1e-6).y[:, -1]
    error_m = float(np.linalg.norm(propagate(LEO[:, None], 6000.0, NORTH)[:3, 0] - theirs[:3]))
    back_m = float(np.linalg.norm(propagate(propagate(LEO[:, None], 600.0, NORTH), -600.0, NORTH)[:3, 0] - LEO[:3]))
    check(error_m < 1.0 and back_m < 0.05, f"a revolution as scipy's DOP853 has it, within {error_m:.3f} m; and back: {back_m:.4f} m")


def nodes_precess():
    """The mean rate of the node, -3/2 n J2 (R/p)^2 cos i, over ten revolutions."""
    def node(state):
        momentum = np.cross(state[:3], state[3:])
        return math.atan2(momentum[0], -momentum[1])

    semi_major = 1.0 / (2.0 / 7.2e6 - 7440.0 ** 2 / GM_M3_PER_S2)
    motion = math.sqrt(GM_M3_PER_S2 / semi_major ** 3)
    span_s = 10.0 * 2.0 * math.pi / motion
    rate = (node(propagate(LEO[:, None], span_s, NORTH)[:, 0]) - node(LEO)) / span_s
    expected = -1.5 * motion * J2 * (EARTH_RADIUS_M / semi_major) ** 2 * math.cos(INCLINATION)
    check(abs(rate / expected - 1.0) < 0.01, f"the node precesses by {math.degrees(rate) * 86400:.4f} deg a day, "
          f"analytically {math.degrees(expected) * 86400:.4f}")


def the_pole_is_that_of_date():
    """Reference: ERFA 2.0, eraXys06a(2458139.5, 0.0): X, Y of the celestial pole."""
    x, y = 0.0017330308, -0.0000365643
    pole = pole_of(datetime.datetime(2018, 1, 21))
    off = math.degrees(math.hypot(pole[0] - x, pole[1] - y)) * 60.0
    check(off < 0.5, f"the pole is {off:.2f} arcmin from that of date")


def light_takes_its_time():
    """An object that moves across the line of sight at v is seen v/c behind."""
    state = np.array([1e7, 0.0, 0.0, 0.0, 7000.0, 0.0])
    seen = apparent_direction(state[:, None], np.zeros(3))[:, 0]
    check(abs(math.atan2(seen[1], seen[0]) + 7000.0 / 299792458.0) < 1e-12, "objects are seen where light left them")


def sight_of(origin, direction, sigma_rad, rng, time_ns=0):
    """A line of sight that is wrong by sigma on both axes."""
    true = LineOfSight(time_ns, origin, direction, sigma_rad ** 2 * np.eye(2))
    wrong = direction + true.tangents.T @ (sigma_rad * rng.normal(size=2))
    return LineOfSight(time_ns, origin, wrong / np.linalg.norm(wrong), sigma_rad ** 2 * np.eye(2))


SITES = [6.371e6 * direction_of(math.radians(ra), math.radians(dec)) for ra, dec in ((0.0, 33.0), (3.0, 32.0), (-2.0, 35.0))]


def triangulations_are_honest():
    rng = np.random.default_rng(1)
    position = np.array([5.9e6, 0.3e6, 4.0e6])
    errors, nees, misses = [], [], []
    for _ in range(2000):
        a, b = (sight_of(site, (position - site) / np.linalg.norm(position - site), ARCSEC, rng) for site in SITES[:2])
        found = triangulate(a, b)
        error = found.position_m - position
        errors.append(float(np.linalg.norm(error)))
        nees.append(float(error @ np.linalg.solve(found.covariance_m2, error)))
        misses.append(found.miss_squared)
    check(np.percentile(errors, 95) < 50.0, f"95 % of positions of two sites at 1 arcsec are within {np.percentile(errors, 95):.1f} m")
    check(abs(np.mean(nees) / 3.0 - 1.0) < 0.1 and abs(np.mean(misses) - 1.0) < 0.1,
          f"squared errors over their covariance are {np.mean(nees):.2f} of 3, distances of lines {np.mean(misses):.2f} of 1")
    away = LineOfSight(0, SITES[0], -a.direction, a.covariance_rad2)
    check(triangulate(away, b) is None and triangulate(a, a) is None, "lines that do not meet give no position")


def orbits_are_honest():
    rng = np.random.default_rng(2)
    start = np.array([5.9e6, 0.3e6, 4.0e6, -3300.0, -4000.0, 5170.0])
    nees, chi = [], []
    for _ in range(200):
        sights = []
        for time_s in (-20.0, -10.0, 0.0):
            state = propagate(start[:, None], time_s, NORTH)
            sights += [sight_of(site, apparent_direction(state, site)[:, 0], ARCSEC, rng, int(time_s * 1e9)) for site in SITES]
        orbit = fit_orbit(sights, start + [300.0, -200.0, 100.0, 5.0, -5.0, 3.0], 0, NORTH)
        error = orbit.state - start
        nees.append(float(error @ np.linalg.solve(orbit.covariance, error)))
        chi.append(orbit.chi_squared)
    check(abs(np.mean(nees) / 6.0 - 1.0) < 0.15 and abs(np.mean(chi) / 12.0 - 1.0) < 0.1,
          f"fits of nine lines: squared errors {np.mean(nees):.2f} of 6, chi-squared {np.mean(chi):.2f} of 12")
    check(is_bound(start) and not is_bound(start * [1, 1, 1, 2, 2, 2]) and not is_bound(start * [1, 1, 1, 0, 0, 0]),
          "hyperbolas and what falls are no orbits")


if __name__ == "__main__":
    try:
        accelerations_are_gradients()
        steps_are_short_enough()
        nodes_precess()
        the_pole_is_that_of_date()
        light_takes_its_time()
        triangulations_are_honest()
        orbits_are_honest()
    except Failure as failure:
        sys.exit(f"FAIL: {failure}")
