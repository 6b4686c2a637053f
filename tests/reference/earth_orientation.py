"""Earth orientation and geodesy by ERFA and a site-satellite pair by skyfield, for tests/frames."""
import erfa
import numpy as np

np.set_printoptions(precision=17, floatmode="fixed")
ARCSEC = np.pi / 180 / 3600


def show(name, values):
    print(name, ", ".join(f"{v:.16g}" for v in np.ravel(values)))


# 2018-01-21T00:00:00 UTC, with invented but plausible UT1 - UTC and polar motion.
dut1, xp, yp = 0.2, 0.06 * ARCSEC, 0.27 * ARCSEC
utc = erfa.dtf2d("UTC", 2018, 1, 21, 0, 0, 0.0)
tt = erfa.taitt(*erfa.utctai(*utc))
ut1 = erfa.utcut1(*utc, dut1)
show("c2t06a", erfa.c2t06a(*tt, *ut1, xp, yp))
show("c2t00b", erfa.c2t00b(*tt, *ut1, xp, yp))
show("era00", erfa.era00(*ut1))
show("gmst82", erfa.gmst82(*ut1))

# A fixed point's velocity: difference of its GCRS positions over +-1 s of UT1, frozen axes.
site = np.array([-742e3, -5462e3, 3198e3])
rc2i, pom = erfa.c2i06a(*tt), erfa.pom00(xp, yp, erfa.sp00(*tt))
rate = 2 * np.pi * 1.00273781191135448 / 86400
omega = np.array([0, 0, rate])
rotation = erfa.rz(erfa.era00(*ut1), np.eye(3))
show("velocity", rc2i.T @ rotation.T @ np.cross(omega, pom.T @ site))

# Geodetic to geocentric, WGS 84 (n = 1).
for lon, lat, h in ((-84.398, 33.777, 300.0), (0.0, 90.0, 0.0), (180.0, -45.0, 35786e3),
                    (70.0, -0.001, -400.0)):
    show(f"gd2gc {lon} {lat} {h}", erfa.gd2gc(1, np.radians(lon), np.radians(lat), h))
