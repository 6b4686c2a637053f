#!/usr/bin/env python3
"""Writes tests/docs/every_key/orbit.sp3, circular orbits in closed form seen from the turning Earth, and prints what tests/orbit needs.

    sp3_orbit.py                    writes the file and prints states between its epochs
    sp3_orbit.py SP3.gz FINALS.gz   prints in GCRS, by astropy with the IERS file, where some epochs of an SP3 in TAI are
"""
import datetime
import gzip
import math
import pathlib
import sys

GM = 3.986004415e14  # m^3/s^2, IERS Conventions 2010
EARTH = 7.2921151467e-5  # rad/s
START = datetime.datetime(2018, 1, 21, 0, 10, 18)  # GPS
STEP_S, EPOCHS = 60, 14
# Identifier: radius [m], inclination, node and argument of latitude at the first epoch [rad]; whether velocities are stated.
ORBITS = {"L71": (7.2e6, 1.7, 0.4, 0.1, True), "G05": (26.56e6, 0.96, 2.0, 1.0, False), "L72": (7.3e6, 1.2, 3.0, 0.5, True)}
ABSENT = {("L72", 5)}  # neither position nor velocity
WITHOUT_CLOCK = 999999.999999


def state(orbit, t):
    """Position [m] and velocity [m/s] in axes that turn with the Earth."""
    radius, inclination, node, u0, _ = ORBITS[orbit]
    rate = math.sqrt(GM / radius**3)
    u, w = u0 + rate * t, node - EARTH * t
    cu, su, cw, sw, ci, si = math.cos(u), math.sin(u), math.cos(w), math.sin(w), math.cos(inclination), math.sin(inclination)
    position = [radius * (cw * cu - sw * su * ci), radius * (sw * cu + cw * su * ci), radius * su * si]
    inertial = [radius * rate * (-cw * su - sw * cu * ci), radius * rate * (-sw * su + cw * cu * ci), radius * rate * cu * si]
    return position, [inertial[0] + EARTH * position[1], inertial[1] - EARTH * position[0], inertial[2]]


def stamp(time):
    return f"{time.year:4d} {time.month:2d} {time.day:2d} {time.hour:2d} {time.minute:2d} {time.second:11.8f}"


def row(mark, orbit, values):
    return f"{mark}{orbit}" + "".join(f"{v:14.6f}" for v in [*values, WITHOUT_CLOCK])


def sp3():
    ids = "".join(ORBITS) + "  0" * (17 - len(ORBITS))
    none = "  0" * 17
    yield f"#cV{stamp(START)} {EPOCHS:7d} ORBIT ITRF  FIT TEST"
    yield f"## 1985 {600 + 18:15.8f} {STEP_S:14.8f} 58139 0.0070370370370"
    yield f"+   {len(ORBITS):2d}   {ids}"
    yield from [f"+        {none}"] * 4
    yield from [f"++       {none}"] * 5
    yield "%c M  cc GPS ccc cccc cccc cccc cccc ccccc ccccc ccccc ccccc"
    yield "%c cc cc ccc ccc cccc cccc cccc cccc ccccc ccccc ccccc ccccc"
    yield from ["%f  1.2500000  1.025000000  0.00000000000  0.000000000000000", "%f  0.0000000  0.000000000  0.00000000000  0.000000000000000"]
    yield from ["%i    0    0    0    0      0      0      0      0         0"] * 2
    yield from ["/* Circular orbits in closed form, for tests."] * 4
    for k in range(EPOCHS):
        yield f"*  {stamp(START + datetime.timedelta(seconds=STEP_S * k))}"
        for orbit, (*_, with_velocity) in ORBITS.items():
            position, velocity = state(orbit, STEP_S * k)
            absent = (orbit, k) in ABSENT
            yield row("P", orbit, [0.0 if absent else x / 1e3 for x in position])
            yield row("V", orbit, [0.0 if absent or not with_velocity else x * 10 for x in velocity])
    yield "EOF"


def write():
    path = pathlib.Path(__file__).parent.parent / "docs/every_key/orbit.sp3"
    path.write_text("\n".join(sp3()) + "\n")
    for orbit, t in (("L71", 30), ("L71", 397), ("G05", 30), ("G05", 397)):
        position, velocity = state(orbit, t)
        print(orbit, t, ", ".join(f"{x:.4f}" for x in position), " ", ", ".join(f"{x:.6f}" for x in velocity))


def places(path, finals):
    """Epochs of an SP3 of one satellite in TAI: in ITRS as stated, in GCRS by astropy."""
    import tempfile

    from astropy import units as u
    from astropy.coordinates import GCRS, ITRS, CartesianRepresentation
    from astropy.time import Time
    from astropy.utils import iers

    with tempfile.NamedTemporaryFile(suffix=".all") as plain:
        plain.write(gzip.open(finals).read())
        plain.flush()
        table = iers.IERS_A.open(plain.name)
    iers.conf.auto_download = False
    iers.earth_orientation_table.set(table)
    lines = gzip.open(path, "rt").read().splitlines()
    starts = [k for k, line in enumerate(lines) if line.startswith("*")]
    for k in (0, 600, 1201):
        y, mo, d, h, mi, s = lines[starts[k]][1:].split()
        text = f"{y}-{int(mo):02d}-{int(d):02d}T{int(h):02d}:{int(mi):02d}:{float(s):06.3f}"
        time = Time(text, scale="tai")
        position = [float(lines[starts[k] + 1][5 + 14 * i - 1 : 5 + 14 * i + 13]) for i in range(3)]
        itrs = ITRS(CartesianRepresentation(*position, unit=u.km), obstime=time)
        gcrs = itrs.transform_to(GCRS(obstime=time)).cartesian.xyz.to_value(u.m)
        print(text, "TAI", ", ".join(f"{x:.4f}" for x in gcrs))


if __name__ == "__main__":
    if len(sys.argv) == 3:
        places(*sys.argv[1:])
    else:
        write()
