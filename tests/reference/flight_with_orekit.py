#!/usr/bin/env python3
"""Flights of a day by Orekit with the forces that tests/forces/test_numerical_flight.cpp states: writes tests/reference/flight_orekit.inc.
Needs a JDK, and orekit-jpype, satkit-data (DE440, leap seconds) and brahe (EGM2008) from PyPI; finals2000A.all.gz in $DMISE_DATA/eop.
flight_with_orekit.py [--check]"""
import gzip
import math
import os
import pathlib
import sys
import tempfile

import brahe
import orekit_jpype

ROOT = pathlib.Path(__file__).resolve().parents[2]
TARGET = ROOT / "tests/reference/flight_orekit.inc"
START = (2018, 12, 24, 22, 0, 0.0)  # UTC
DEGREE = 20
# The case "manoeuvres" has a burn, and later a change of velocity at once; radial, transverse, normal.
BURN = {"at_s": 3600.0, "duration_s": 600.0, "thrust_n": 22.0, "mass_kg": 500.0, "isp_s": 220.0, "direction": (0.48, 0.64, -0.6)}
IMPULSE = {"at_s": 10000.0, "delta_v_m_per_s": (0.5, -3.0, 2.0)}
# name, position [m], velocity [m/s], Cd A/m, Cr A/m [m^2/kg], gravity degree, Sun and Moon, tides
LEO = ((-4069503.0, 2861786.0, 4483608.0), (-5114.2, -5691.6, -1000.9))  # 6694 km
CASES = [
    ("gravity", *LEO, 0, 0, 20, False),
    ("gravity_70", *LEO, 0, 0, 70, False),
    ("low", (6878137.0, 0.0, 0.0), (0.0, -944.0, 7553.0), 0.022, 0.013, 20, True),
    ("polar", (7192000.0, 0.0, 0.0), (0.0, -1085.0, 7364.0), 0.022, 0.013, 50, True),
    ("molniya", (0.0, 7000e3, 0.0), (-4500.0, 0.0, 8900.0), 0.022, 0.013, 20, True),
    ("geo", (42164.17e3, 0.0, 0.0), (0.0, 3074.66, 1.0), 0.0, 0.026, 20, True),
    ("manoeuvres", (6878137.0, 0.0, 0.0), (0.0, -944.0, 7553.0), 0, 0, 20, False),
    ("hyperbola", (8e6, 0.0, 0.0), (0.0, 9000.0, 6000.0), 0.0, 0.013, 20, True),
]
AIR = [(0, 1.225), (25, 3.899e-2), (30, 1.774e-2), (40, 3.972e-3), (50, 1.057e-3), (60, 3.206e-4), (70, 8.770e-5), (80, 1.905e-5),
       (90, 3.396e-6), (100, 5.297e-7), (110, 9.661e-8), (120, 2.438e-8), (130, 8.484e-9), (140, 3.845e-9), (150, 2.070e-9),
       (180, 5.464e-10), (200, 2.789e-10), (250, 7.248e-11), (300, 2.418e-11), (350, 9.518e-12), (400, 3.725e-12), (450, 1.585e-12),
       (500, 6.967e-13), (600, 1.454e-13), (700, 3.614e-14), (800, 1.170e-14), (900, 5.245e-15), (1000, 3.019e-15)]  # Vallado, table 8-4


def density(height_km):
    """Between the heights of the table the logarithm is linear; above, the scale is 268 km."""
    if height_km >= 5000:
        return 0.0
    i = max(k for k, row in enumerate(AIR) if row[0] <= max(height_km, 0))
    h0, rho0 = AIR[i]
    scale = 268.0 if i + 1 == len(AIR) else (AIR[i + 1][0] - h0) / math.log(rho0 / AIR[i + 1][1])
    return rho0 * math.exp((h0 - height_km) / scale)


def write_data(folder):
    import satkit_data
    packaged = pathlib.Path(satkit_data.__file__).parent / "data"
    os.symlink(packaged / "linux_p1550p2650.440", folder / "lnxp1550p2650.440")
    data = pathlib.Path(os.environ.get("DMISE_DATA", ROOT.parent / "shared/data"))
    (folder / "finals2000A.all").write_text(gzip.open(data / "eop/finals2000A.all.gz", "rt").read())
    lines = []
    for line in (packaged / "leap-seconds.list").read_text().splitlines():
        if line and line[0] != "#":
            seconds, offset = line.split()[:2]
            mjd = int(seconds) // 86400 + 15020
            date = (__import__("datetime").date(1858, 11, 17) + __import__("datetime").timedelta(mjd))
            lines.append(" %4d %s %2d =JD %9.1f  TAI-UTC=%12.7f S + (MJD - 41317.) X 0.0      S" % (
                date.year, date.strftime("%b").upper(), date.day, mjd + 2400000.5, float(offset)))
    (folder / "tai-utc.dat").write_text("\n".join(lines) + "\n")
    model = brahe.GravityModel.from_model_type(brahe.GravityModelType.EGM2008_120)
    gfc = ["product_type gravity_field", "modelname EGM2008", "earth_gravity_constant %.10e" % model.gm, "radius %.10e" % model.radius,
           "max_degree 70", "errors no", "norm fully_normalized", "tide_system tide_free", "end_of_head", "gfc 0 0 1.0 0.0", "gfc 1 0 0.0 0.0",
           "gfc 1 1 0.0 0.0"]
    gfc += ["gfc %d %d %.15e %.15e" % ((n, m) + tuple(model.get(n, m))) for n in range(2, 71) for m in range(n + 1)]
    (folder / "egm2008.gfc").write_text("\n".join(gfc) + "\n")


def main():
    orekit_jpype.initVM()
    from orekit_jpype.pyhelpers import setup_orekit_curdir
    from jpype import JImplements, JOverride
    with tempfile.TemporaryDirectory() as name:
        write_data(pathlib.Path(name))
        setup_orekit_curdir(name)
        text = flights(JImplements, JOverride)
    if "--check" in sys.argv[1:]:
        sys.exit(0 if TARGET.read_text() == text else f"{TARGET} is not what this script writes")
    TARGET.write_text(text)


def add_manoeuvres(propagator, gcrf, start):
    from org.hipparchus.geometry.euclidean.threed import Vector3D
    from org.orekit.attitudes import LofOffset
    from org.orekit.forces.maneuvers import ConstantThrustManeuver, ImpulseManeuver
    from org.orekit.frames import LOFType
    from org.orekit.propagation.events import DateDetector
    along_rtn = LofOffset(gcrf, LOFType.QSW)
    propagator.setAttitudeProvider(along_rtn)
    propagator.addForceModel(ConstantThrustManeuver(start.shiftedBy(BURN["at_s"]), BURN["duration_s"], BURN["thrust_n"], BURN["isp_s"],
                                                    Vector3D(*BURN["direction"])))
    propagator.addEventDetector(ImpulseManeuver(DateDetector(start.shiftedBy(IMPULSE["at_s"])), along_rtn,
                                                Vector3D(*IMPULSE["delta_v_m_per_s"]), 300.0))


def flights(JImplements, JOverride):
    from org.hipparchus.geometry.euclidean.threed import Vector3D
    from org.hipparchus.ode.nonstiff import DormandPrince853Integrator
    from org.orekit.bodies import CelestialBodyFactory, OneAxisEllipsoid
    from org.orekit.forces.drag import DragForce, IsotropicDrag
    from org.orekit.forces.gravity import HolmesFeatherstoneAttractionModel, Relativity, SolidTides, ThirdBodyAttraction
    from org.orekit.forces.gravity.potential import GravityFieldFactory, ICGEMFormatReader, TideSystem
    from org.orekit.forces.radiation import IsotropicRadiationSingleCoefficient, SolarRadiationPressure
    from org.orekit.frames import FramesFactory
    from org.orekit.orbits import CartesianOrbit, OrbitType
    from org.orekit.propagation import SpacecraftState
    from org.orekit.propagation.numerical import NumericalPropagator
    from org.orekit.time import AbsoluteDate, TimeScalesFactory
    from org.orekit.utils import IERSConventions, PVCoordinates

    gcrf = FramesFactory.getGCRF()
    itrf = FramesFactory.getITRF(IERSConventions.IERS_2010, True)
    utc = TimeScalesFactory.getUTC()
    start = AbsoluteDate(*START, utc)
    ut1 = TimeScalesFactory.getUT1(IERSConventions.IERS_2010, True)
    GravityFieldFactory.addPotentialCoefficientsReader(ICGEMFormatReader("egm2008.gfc", False))
    sun, moon = CelestialBodyFactory.getSun(), CelestialBodyFactory.getMoon()
    earth = OneAxisEllipsoid(6378137.0, 1 / 298.257223563, itrf)

    def sphere_height_km(p):
        r = p.getNorm()
        return (r - 6378137.0 * (1 - (p.getZ() / r) ** 2 / 298.257223563)) / 1e3

    @JImplements("org.orekit.models.earth.atmosphere.Atmosphere")
    class Air:
        @JOverride
        def getFrame(self):
            return itrf

        @JOverride
        def getDensity(self, date, position, frame):
            return density(sphere_height_km(frame.getStaticTransformTo(itrf, date).transformPosition(position)))

        @JOverride
        def getVelocity(self, date, position, frame):
            to_body = frame.getTransformTo(itrf, date)
            pv = to_body.transformPVCoordinates(PVCoordinates(position, Vector3D.ZERO))
            still = to_body.getInverse().transformPVCoordinates(PVCoordinates(pv.getPosition(), Vector3D.ZERO))
            return still.getVelocity()

    lines = ["// Made by tests/reference/flight_with_orekit.py: Orekit %s. {name, degree, Sun and Moon, drag, radiation [m2/kg]," % "13.1",
             "// {x, y, z [m]}, {x, y, z [m/s]} at the start, and after 6, 12, 18 and 24 h}"]
    for name, position, velocity, drag, radiation, degree, bodies in CASES:
        integrator = DormandPrince853Integrator(1e-6, 300.0, 1e-7, 1e-14)
        propagator = NumericalPropagator(integrator)
        propagator.setOrbitType(OrbitType.CARTESIAN)
        field = GravityFieldFactory.getNormalizedProvider(degree, degree)
        mu = field.getMu()
        propagator.addForceModel(HolmesFeatherstoneAttractionModel(itrf, field))
        propagator.addForceModel(Relativity(mu))
        if bodies:
            propagator.addForceModel(ThirdBodyAttraction(sun))
            propagator.addForceModel(ThirdBodyAttraction(moon))
            propagator.addForceModel(SolidTides(itrf, field.getAe(), mu, TideSystem.TIDE_FREE, IERSConventions.IERS_2010, ut1,
                                                [sun, moon]))
        if drag:
            propagator.addForceModel(DragForce(Air(), IsotropicDrag(drag, 1.0)))
        if radiation:
            propagator.addForceModel(SolarRadiationPressure(149597870700.0, 1361.0 / 299792458.0, sun, earth,
                                                            IsotropicRadiationSingleCoefficient(radiation, 1.0)))
        orbit = CartesianOrbit(PVCoordinates(Vector3D(*position), Vector3D(*velocity)), gcrf, start, mu)
        mass_kg = BURN["mass_kg"] if name == "manoeuvres" else 1.0  # so that areas are areas over mass
        propagator.setInitialState(SpacecraftState(orbit).withMass(mass_kg))
        if name == "manoeuvres":
            add_manoeuvres(propagator, gcrf, start)
        states = []
        for hour in (6, 12, 18, 24):
            pv = propagator.propagate(start.shiftedBy(3600.0 * hour)).getPVCoordinates(gcrf)
            p, v = pv.getPosition(), pv.getVelocity()
            states.append("{{%.6f, %.6f, %.6f}, {%.9f, %.9f, %.9f}}" % (p.getX(), p.getY(), p.getZ(), v.getX(), v.getY(), v.getZ()))
        lines.append('{"%s", %d, %s, %r, %r, {{%r, %r, %r}, {%r, %r, %r}},\n{%s}},' % (
            name, degree, str(bodies).lower(), drag, radiation, *position, *velocity, ",\n".join(states)))
        print(lines[-1], file=sys.stderr)
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    main()
