#!/usr/bin/python3
"""What leaves the chain of models, by other people's: the figures of tests/pipeline/test_site_place.cpp,
test_star_trail.cpp, test_penumbra.cpp and test_truth.cpp, with ERFA (as astropy uses it) and skyfield.
Usage: wiring.py [NAME ...] of its functions; all without arguments.
"""
import sys

import erfa
import numpy as np

DEG, ARCSEC = np.pi / 180, np.pi / 180 / 3600
AU, SUN_RADIUS = 1.495978707e11, 6.957e8


def scales(utc, dut1=0.0):
    """TT and UT1 of a UTC as (year, month, day, hour, minute, second)."""
    utc = erfa.dtf2d("UTC", *utc)
    return erfa.taitt(*erfa.utctai(*utc)), erfa.utcut1(*utc, dut1), utc


def sun_m(tt):
    return -erfa.epv00(*tt)[0]["p"] * AU


def site():
    """GCRS place of a site with the IERS' UT1 and pole of MJD 58183.5."""
    dut1 = 0.5 * (0.1604862 + 0.1595412)
    xp, yp = 0.5 * (0.006531 + 0.007282) * ARCSEC, 0.5 * (0.354263 + 0.356648) * ARCSEC
    tt, ut1, _ = scales((2018, 3, 6, 12, 0, 0.0), dut1)
    place = erfa.gd2gc(1, -70.7 * DEG, -30.2 * DEG, 2000.0)
    gcrs = erfa.c2t06a(*tt, *ut1, xp, yp).T @ place
    print("site", ", ".join(f"{x:.3f}" for x in gcrs))
    ut1 = scales((2018, 3, 6, 12, 0, 0.0))[1]
    print("  with UTC for UT1", np.linalg.norm(erfa.c2t06a(*tt, *ut1, xp, yp).T @ place - gcrs), "m away")


TRAIL = dict(ra=125.0, dec=10.0, site=(33.777, -84.398, 300.0), air=(980.0, 12.0, 0.6), um=0.55)


def observed(seconds, star=TRAIL):
    """Azimuth and apparent elevation of a star after 2018-01-21T00:00:00 UTC, UT1 = UTC."""
    utc = erfa.dtf2d("UTC", 2018, 1, 21, 0, 0, 0.0)
    lat, lon, height = star["site"]
    az, zenith, *_ = erfa.atco13(star["ra"] * DEG, star["dec"] * DEG, 0, 0, 0, 0, utc[0], utc[1] + seconds / 86400, 0.0,
                                 lon * DEG, lat * DEG, height, 0, 0, *star["air"], star["um"])
    return az, np.pi / 2 - zenith


def on_plane(azimuth, elevation, boresight, roll, focal_px, centre_px):
    """Pixel of a direction in a gnomonic camera whose up is towards the zenith turned by `roll` to the right."""
    def unit(az, el):
        return np.array([np.sin(az) * np.cos(el), np.cos(az) * np.cos(el), np.sin(el)])

    az, el = boresight
    v = unit(azimuth, elevation)
    forward, right = unit(az, el), np.array([np.cos(az), -np.sin(az), 0.0])
    up = np.cross(right, forward)
    x, y = v @ right / (v @ forward), -(v @ up) / (v @ forward)
    c, s = np.cos(roll), np.sin(roll)
    return centre_px[0] + focal_px * (c * x + s * y), centre_px[1] + focal_px * (c * y - s * x)


def trail():
    """Ends of the trail of a star that rises through 10 deg in the middle of 600 s."""
    low, high = 0.0, 6 * 3600.0
    while high - low > 1e-3:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if observed(middle)[1] < 10 * DEG else (low, middle)
    start = round(low) - 300
    az, el = observed(start + 300)
    (az0, el0), (az1, el1) = observed(start), observed(start + 600)
    roll = np.arctan2(-(el1 - el0), (az1 - az0) * np.cos(el))
    print(f"trail: start {start} s, azimuth {az / DEG:.6f}, elevation {el / DEG:.6f}, roll {roll / DEG:.6f}")
    boresight = (round(az / DEG, 3) * DEG, round(el / DEG, 3) * DEG)
    roll = round(roll / DEG, 3) * DEG
    for t in (0, 300, 600):
        print("  ", t, "s: elevation %.4f" % (observed(start + t)[1] / DEG), "pixel %.3f, %.3f" % on_plane(
            *observed(start + t), boresight, roll, 0.2 / 1e-5, (499.5, 63.5)))


def sunlit(p, sun, n=40000):
    """Share of the Sun's disc that the ellipsoid WGS 84 leaves free: see shadow.py."""
    k = np.arange(n) + 0.5
    rho, phi = np.sqrt(k / n), k * np.pi * (3 - np.sqrt(5))
    line = sun - p
    d = np.linalg.norm(line)
    u = line / d
    e = np.cross(u, [0.3, -0.5, 0.8])
    e /= np.linalg.norm(e)
    f = np.cross(u, e)
    sine = rho * SUN_RADIUS / d
    rays = np.sqrt(1 - sine**2)[:, None] * u + (sine * np.cos(phi))[:, None] * e + (sine * np.sin(phi))[:, None] * f
    scale = 1 / np.array([6378137.0, 6378137.0, 6356752.314245179])
    ps, rs = p * scale, rays * scale
    along, length = rs @ ps, np.sum(rs * rs, axis=1)
    return 1 - ((along < 0) & (along**2 > length * (ps @ ps - 1))).mean()


def sphere_light(p, observer, sun):
    """Light of a diffuse sphere, relative: F(phase) / (d R)^2."""
    to_sun, to_observer = sun - p, observer - p
    d, r = np.linalg.norm(to_observer), np.linalg.norm(to_sun)
    phi = np.arccos(to_sun @ to_observer / (d * r))
    return 2 / (3 * np.pi**2) * ((np.pi - phi) * np.cos(phi) + np.sin(phi)) / (d * d * (r / AU) ** 2), phi, d, r


def penumbra():
    """Where along its path the light of a sphere on a circular equatorial orbit lies that enters the penumbra."""
    a, mu = 42164e3, 3.986004418e14
    rate = np.sqrt(mu / a**3)
    tt = scales((2018, 3, 20, 0, 0, 30.0))[0]
    sun = sun_m(tt)
    eye = np.array([-1e7, 0.0, 2e7])

    def at(anomaly, t):
        u = anomaly + rate * t
        return a * np.array([np.cos(u), np.sin(u), 0.0])

    low, high = 100 * DEG, np.arctan2(sun[1], sun[0]) % (2 * np.pi) + np.pi  # from lit to the middle of the shadow
    high = high if high > low else high + 2 * np.pi
    while high - low > 1e-9:  # 0.55 of the Sun is left at the end of 60 s
        middle = 0.5 * (low + high)
        low, high = (middle, high) if sunlit(at(middle, 60.0), sun) > 0.55 else (low, middle)
    start = round(low / DEG, 5) * DEG
    t = np.linspace(0, 60, 241)
    lit = np.array([sunlit(at(start, x), sun) for x in t])
    light = lit * [sphere_light(at(start, x), eye, sun)[0] for x in t]
    weight = np.ones_like(t)
    weight[[0, -1]] = 0.5
    mean = (weight * light * t).sum() / (weight * light).sum() / 60
    print(f"penumbra: anomaly {start / DEG:.5f}, sunlit {lit[0]:.4f} to {lit[-1]:.4f}, mean "
          f"{(weight * lit).sum() / weight.sum():.4f}, centroid at {mean:.4f} of the path; reversed {1 - mean:.4f}")
    middle = at(start, 30.0) - eye
    print("  ra %.5f dec %.5f" % (np.arctan2(middle[1], middle[0]) / DEG % 360,
                                  np.arcsin(middle[2] / np.linalg.norm(middle)) / DEG))


def refraction():
    """ERFA's eraRefco at an apparent elevation of 20 deg, 1000 hPa, -5 C, humidity 0.3."""
    tan = np.tan(70 * DEG)
    for um in (0.438, 0.798, 0.4):
        a, b = erfa.refco(1000.0, -5.0, 0.3, um)
        print(f"refraction at {um} um: {(a * tan + b * tan**3) / ARCSEC:.4f} arcsec")


def aberrated(p, velocity):
    v = velocity / erfa.CMPS
    return erfa.ab(p, v, 1e9, np.sqrt(1 - v @ v))


def proper(star, tt, observer_m, velocity):
    """Direction of a star (ra, dec, proper motions a year, parallax ["]) at an observer near the Earth, without air."""
    earth = erfa.epv00(*tt)
    eb, v = earth[1]["p"] + observer_m / AU, earth[1]["v"] * AU / 86400 + velocity
    eh = earth[0]["p"] + observer_m / AU
    ra, dec, pmr, pmd, px = star
    years = (tt[0] - 2451545 + tt[1]) / 365.25
    p = erfa.pmpx(ra * DEG, dec * DEG, pmr * ARCSEC / np.cos(dec * DEG), pmd * ARCSEC, px, 0.0, years, eb)
    p = erfa.ldsun(p, eh / np.linalg.norm(eh), np.linalg.norm(eh))
    v = v / erfa.CMPS
    return erfa.ab(p, v, np.linalg.norm(eh), np.sqrt(1 - v @ v))


def star():
    """A near star from a site, without air, UT1 = UTC."""
    tt, ut1, _ = scales((2018, 3, 6, 12, 0, 5.0))
    rotation = erfa.c2t06a(*tt, *ut1, 0.0, 0.0)
    site = rotation.T @ erfa.gd2gc(1, -70.7 * DEG, -30.2 * DEG, 2000.0)
    pole = erfa.c2i06a(*tt)[2]
    velocity = np.cross(7.292115146706979e-5 * pole, site)
    print("star", ", ".join("%.10f" % x for x in proper((217.43, -62.68, -3.775, 0.765, 0.7687), tt, site, velocity)))


def platform():
    """A circular orbit from its node, 300 and 600 s on, and a star's place there by the velocity then."""
    a, i = 7178137.0, 98.6 * DEG
    n = np.sqrt(3.986004418e14 / a**3)
    for t in (300, 600):
        c, s = np.cos(n * t), np.sin(n * t)
        place = a * np.array([c, s * np.cos(i), s * np.sin(i)])
        velocity = a * n * np.array([-s, c * np.cos(i), c * np.sin(i)])
        tt = scales((2018, 3, 6, 12, t // 60, 0.0))[0]
        print(f"platform {t} s:", ", ".join("%.3f" % x for x in place), "|", ", ".join("%.5f" % x for x in velocity), "|",
              ", ".join("%.10f" % x for x in proper((217.43, -62.68, 0, 0, 0), tt, place, velocity)))
    print("  turns in 10 s by %.9f rad" % (10 * n))


def moon():
    """Krisciunas & Schaefer's moonlight in the zenith by the Moon of ERFA, V, k = 0.17, in S10 (1 S10 = 27.78 mag/arcsec2); within
    7 deg of opposition brighter, by 35 % at 0 and linearly in magnitudes."""
    from moonlight import moon_nl

    for day in ((2018, 1, 31), (2018, 7, 27)):
        utc = (*day, 6, 0, 0.5)
        tt, ut1, _ = scales(utc)
        itrs = erfa.c2t06a(*tt, *ut1, 0.0, 0.0)
        site = itrs.T @ erfa.gd2gc(1, -70.7 * DEG, -30.2 * DEG, 2000.0)
        up = itrs.T @ np.array([np.cos(-30.2 * DEG) * np.cos(-70.7 * DEG), np.cos(-30.2 * DEG) * np.sin(-70.7 * DEG),
                                np.sin(-30.2 * DEG)])
        moon = erfa.moon98(*tt)["p"] * AU
        line, to_sun = moon - site, sun_m(tt) - moon
        d = np.linalg.norm(line)
        altitude = np.arcsin(line @ up / d) / DEG
        phase = np.arccos(-line @ to_sun / (d * np.linalg.norm(to_sun))) / DEG
        nl = moon_nl(phase, 90 - altitude, 0, 90 - altitude, 0.17) * (384400e3 / d) ** 2 * 1.35 ** max(0, 1 - phase / 7)
        v = (20.7233 - np.log(nl / 34.08)) / 0.92104
        print(f"moon {day}: altitude {altitude:.3f}, phase {phase:.3f}, {d / 1e3:.0f} km: {nl:.2f} nL, V {v:.4f}, "
              f"{10 ** (0.4 * (27.78 - v)):.3f} S10")


def truth():
    """Elevation, phase and magnitude of the ISS over a site, by skyfield, UT1 = UTC."""
    from skyfield.api import EarthSatellite, load, wgs84

    ts = load.timescale(delta_t=69.184)
    iss = EarthSatellite("1 25544U 98067A   18020.89808844  .00002078  00000-0  38550-4 0  9992",
                         "2 25544  51.6424  32.9776 0003646  28.7227  39.5332 15.54190080 95614", "ISS", ts)
    time = ts.utc(2018, 1, 21, 0, 15, 5.0)
    below = wgs84.subpoint(iss.at(time))
    lat, lon = round(below.latitude.degrees - 5), round(below.longitude.degrees)
    station = wgs84.latlon(lat, lon, elevation_m=100.0)
    topocentric = (iss - station).at(time)
    elevation, azimuth, distance = topocentric.altaz()
    sun = sun_m(scales((2018, 1, 21, 0, 15, 5.0))[0])
    p, observer = iss.at(time).position.m, station.at(time).position.m
    light, phi, d, r = sphere_light(p, observer, sun)
    magnitude = -26.76 - 2.5 * np.log10(np.pi * 20.0**2 * 0.3 * light)
    ra, dec, _ = topocentric.radec()
    print(f"truth: site {lat}, {lon}: elevation {elevation.degrees:.6f}, azimuth {azimuth.degrees:.6f}, range "
          f"{distance.m:.1f} m, phase {phi / DEG:.6f}, magnitude {magnitude:.5f}, ra {ra._degrees:.6f}, dec {dec.degrees:.6f}")
    print("  position", iss.at(time).position.m.round(2), "m, velocity", (iss.at(time).velocity.km_per_s * 1e3).round(4), "m/s")
    tau = d / erfa.CMPS
    velocity = (np.array(station.at(time).velocity.km_per_s) * 1e3)
    seen = p - tau * np.array(iss.at(time).velocity.km_per_s) * 1e3 - observer
    seen = aberrated(seen / np.linalg.norm(seen), velocity)
    print("  apparent ra %.6f dec %.6f" % (np.arctan2(seen[1], seen[0]) / DEG % 360, np.arcsin(seen[2]) / DEG))
    up = observer / np.linalg.norm(observer)
    print(f"  over a geocentric horizon {np.arcsin((p - observer) @ up / d) / DEG:.6f}; Sun at {r / AU:.6f} au")


for name in sys.argv[1:] or ("site", "star", "platform", "trail", "penumbra", "refraction", "moon", "truth"):
    globals()[name]()
