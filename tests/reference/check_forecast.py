"""What `dmise check --json` says of sensors, against closed forms, astropy and the frames of runs.

    check_forecast.py DMISE

Fields of view by the projections' formulae; Sun's and Moon's elevation by astropy (its own ephemeris, no
air); elevation of a target by the truth of its frames; stars and objects by those drawn; limiting
magnitudes by the magnitude at which half of many sources are found.
"""

import json
import math
import pathlib
import random
import re
import subprocess
import sys
import tempfile
import warnings

try:
    import astropy.units as u
    import numpy as np
    from astropy.coordinates import AltAz, EarthLocation, GCRS, ITRS, CartesianRepresentation, SkyCoord, get_body, get_sun
    from astropy.time import Time
    from astropy.utils import iers
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)

iers.conf.auto_download = False
iers.conf.iers_degraded_accuracy = "ignore"
warnings.simplefilter("ignore")

DETECTOR = "{full_well_e: 60000, gain_e_per_dn: 1, read_noise_e: 6, bias_dn: 200, quantum_efficiency: 0.8}"


def camera(columns=256, rows=192, projection="gnomonic", field_deg=10.0, aperture_m=0.05):
    return (f"{{name: test, optics: {{projection: {projection}, columns: {columns}, rows: {rows}, "
            f"pixel_pitch_m: 1.0e-5, field_of_view_deg: {field_deg!r}, aperture_m: {aperture_m!r}, "
            f"psf_fwhm_px: 1.8, equivalent_aperture: true}}, "
            f"detector: {DETECTOR}, band: {{filter: bessell-V}}}}")


def simulation(start, duration_s=10.0, tick_s=5.0, seed=1):
    return f"simulation: {{start: {start}, duration_s: {duration_s}, tick_s: {tick_s}, seed: {seed}}}\n"


def write(directory, text, name="scenario.yaml"):
    path = directory / name
    path.write_text(text)
    return path


def forecast(binary, path):
    done = subprocess.run([binary, "check", "--json", path], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def check(holds, claim):
    if not holds:
        sys.exit(f"FAIL: {claim}")
    print(f"ok: {claim}")


# Angle from the boresight of the image height h, in focal lengths.
ANGLE = {"gnomonic": math.atan, "equidistant": lambda h: h, "equisolid": lambda h: 2 * math.asin(min(1.0, h / 2)),
         "stereographic": lambda h: 2 * math.atan(h / 2)}
HEIGHT = {"gnomonic": math.tan, "equidistant": lambda a: a, "equisolid": lambda a: 2 * math.sin(a / 2),
          "stereographic": lambda a: 2 * math.tan(a / 2)}


def fields_of_view(binary, directory):
    cases = [(p, f, c, r) for p in ANGLE for f in (0.5, 5.0, 60.0, 120.0, 169.0, 182.0)
             for c, r in ((256, 192), (100, 300)) if p != "gnomonic" or f < 170]
    text = simulation("2018-01-21T00:15:00Z") + "sensors:\n"
    for k, (projection, field, columns, rows) in enumerate(cases):
        text += (f"  - {{name: s{k}, site: atlanta, pointing: zenith, exposure_s: 1, cadence_s: 5, sky: 21.9,\n"
                 f"     camera: {camera(columns, rows, projection, field, 0.001)}}}\n")
    said = forecast(binary, write(directory, text))
    worst = 0.0
    for (projection, field, columns, rows), sensor in zip(cases, said["sensors"]):
        focal_px = columns / 2 / HEIGHT[projection](math.radians(field / 2))
        for key, half_px in (("width", columns / 2), ("height", rows / 2),
                             ("diagonal", math.hypot(columns, rows) / 2)):
            h = half_px / focal_px
            if projection == "equisolid" and h > 2 or projection == "equidistant" and h > math.pi:
                continue
            worst = max(worst, abs(sensor[f"field_{key}_deg"] / math.degrees(2 * ANGLE[projection](h)) - 1))
        worst = max(worst, abs(sensor["pixel_scale_arcsec"] * focal_px / math.degrees(1) / 3600 - 1),
                    abs(sensor["f_number"] / (focal_px * 1e-5 / 0.001) - 1))
    check(worst < 1e-9, f"{len(cases)} cameras of four projections: fields, scales and f-numbers within {worst:.1e}")


def elevations(binary, directory):
    rng = random.Random(7)
    worst_sun = worst_moon = 0.0
    count = 0
    for year in (1975, 1990, 2003, 2018, 2024, 2030):
        start = f"{year}-{rng.randint(1, 12):02}-{rng.randint(1, 28):02}T{rng.randint(0, 23):02}:{rng.randint(0, 59):02}:00Z"
        sites = [(rng.uniform(-90, 90), rng.uniform(-180, 180), rng.uniform(0, 4000)) for _ in range(6)]
        sites += [(90.0, 0.0, 0.0), (-90.0, 0.0, 2800.0)]
        text = simulation(start, duration_s=7200, tick_s=60) + "sensors:\n"
        for k, (latitude, longitude, height) in enumerate(sites):
            text += (f"  - {{name: s{k}, site: {{latitude_deg: {latitude!r}, longitude_deg: {longitude!r}, height_m: {height!r}}}, "
                     f"pointing: zenith, exposure_s: 1, cadence_s: 3000, sky: 21.9, camera: {camera()}}}\n")
        for (latitude, longitude, height), sensor in zip(sites, forecast(binary, write(directory, text))["sensors"]):
            place = EarthLocation.from_geodetic(longitude * u.deg, latitude * u.deg, height * u.m)
            times = Time([f["middle_utc"].rstrip("Z") for f in sensor["frames"]], scale="utc")
            frame = AltAz(obstime=times, location=place, pressure=0 * u.hPa)
            sun = get_sun(times).transform_to(frame).alt.deg
            moon = get_body("moon", times, place).transform_to(frame).alt.deg
            for f, s, m in zip(sensor["frames"], sun, moon):
                worst_sun = max(worst_sun, abs(f["sun_elevation_deg"] - s))
                worst_moon = max(worst_moon, abs(f["moon_elevation_deg"] - m))
                count += 1
    # 20 arcsec of aberration and light time are left out; the Moon's series is good to 10 arcsec; UT1 is UTC,
    # within 0.9 s (13.5 arcsec).
    check(worst_sun < 0.011, f"the Sun at {count} times and places: within {worst_sun:.4f} deg of astropy")
    check(worst_moon < 0.02, f"the Moon: within {worst_moon:.4f} deg of astropy")


def run(binary, path, out):
    done = subprocess.run([binary, "run", path, "--out", out, "--force"], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    lines = lambda name: [json.loads(line) for line in (out / name).read_text().splitlines()]
    return lines("frames.jsonl"), lines("truth.jsonl"), lines("detections.jsonl")


def counts(binary, directory):
    text = (simulation("2018-01-21T00:15:00Z", duration_s=60) + "objects: [{catalogue: demo}]\nstars: {catalogue: kstars}\n"
            "sensors:\n")
    pointings = {"zenith": ("zenith", 30.0), "low": ("{azimuth_deg: 100, elevation_deg: 8}", 20.0),
                 "sky": ("{ra_deg: 83.6, dec_deg: 22.0}", 2.0), "wide": ("{azimuth_deg: 200, elevation_deg: 45}", 60.0),
                 "geo": ("{target: GOES 13}", 4.0)}
    for name, (pointing, field) in pointings.items():
        text += (f"  - {{name: {name}, site: atlanta, pointing: {pointing}, exposure_s: 4, cadence_s: 12, detection: off, "
                 f"camera: {camera(field_deg=field)}}}\n")
    text += "output: {png: false, fits: false}\n"
    path = write(directory, text)
    said = forecast(binary, path)
    frames, truth, _ = run(binary, path, directory / "counts")
    drawn = {(f["sensor"], f["frame"]): f for f in frames}
    seen = {"stars": 0, "objects": 0}
    for sensor in said["sensors"]:
        for f in sensor["frames"]:
            real = drawn[sensor["name"], f["frame"]]
            for key in seen:
                told, is_ = f[key], real[f"{key}_rendered"]
                seen[key] += is_
                # Stars that graze the edge with the last of their light are in doubt.
                check(abs(told - is_) <= (1 if key == "objects" else 2 + 0.03 * is_),
                      f"{sensor['name']} frame {f['frame']}: {told} {key} told, {is_} drawn")
    check(min(seen.values()) > 20, f"counted in all: {seen}")
    target = next(s for s in said["sensors"] if s["name"] == "geo")
    for f in target["frames"]:
        real = [t for t in truth if t["sensor"] == "geo" and t["frame"] == f["frame"] and t["name"].startswith("GOES 13")]
        check(len(real) == 1 and abs(real[0]["true_elevation_deg"] - f["target_elevation_deg"]) < 1e-6,
              f"frame {f['frame']}: the target is at {f['target_elevation_deg']:.3f} deg")


def half_found(magnitudes, found):
    """Magnitude at which half are found: the maximum of the likelihood of a logistic edge."""
    m, y = np.asarray(magnitudes), np.asarray(found, float)
    best = (-np.inf, None)
    for middle in np.arange(m.min(), m.max(), 0.02):
        for width in (0.03, 0.06, 0.1, 0.2, 0.3):
            p = np.clip(1 / (1 + np.exp((m - middle) / width)), 1e-3, 1 - 1e-3)
            best = max(best, (float(np.sum(y * np.log(p) + (1 - y) * np.log(1 - p))), middle))
    return best[1]


def itrs_direction(latitude, longitude, azimuth, elevation):
    """Unit vector of a direction over a site, in Earth-fixed axes."""
    la, lo, a, e = map(math.radians, (latitude, longitude, azimuth, elevation))
    east = np.array([-math.sin(lo), math.cos(lo), 0])
    north = np.array([-math.sin(la) * math.cos(lo), -math.sin(la) * math.sin(lo), math.cos(la)])
    up = np.array([math.cos(la) * math.cos(lo), math.cos(la) * math.sin(lo), math.sin(la)])
    return math.cos(e) * (math.sin(a) * east + math.cos(a) * north) + math.sin(e) * up


SITE = (19.8, -155.5, 4000.0)  # Hawaii; at 06:30 UTC evening has ended, and what is 1000 km up is lit
START = "2018-03-20T06:30:00Z"


def scenario_of(objects, exposure_s, sky, seed, frames):
    text = simulation(START, duration_s=frames * 50, tick_s=5, seed=seed) + "objects:\n" + "".join(objects)
    return text + (f"sensors:\n  - {{name: eye, site: {{latitude_deg: {SITE[0]}, longitude_deg: {SITE[1]}, height_m: {SITE[2]}}},\n"
                   f"     pointing: {{azimuth_deg: 0, elevation_deg: 90}}, exposure_s: {exposure_s}, cadence_s: 50, sky: {sky},\n"
                   f"     effects: {{scintillation: off}}, camera: {camera(512, 512, field_deg=8.0)}}}\n"
                   "output: {png: false, fits: false}\n")


def completeness(binary, directory, make, name, key, exposure_s, sky, frames, seeds):
    """Half-found magnitude of sources around the limit that check tells, less that limit."""
    rng = random.Random(3)
    # One bright source tells the limit, and what magnitude a radius of a metre makes.
    path = write(directory, scenario_of([make(rng, 0, 5.0)], exposure_s, sky, 1, 1))
    told = forecast(binary, path)["sensors"][0]["frames"][0]
    _, truth, _ = run(binary, path, directory / "limit")
    unit_mag = truth[0]["true_magnitude"] + 5 * math.log10(5.0)
    limit = told[key]
    magnitudes, found = [], []
    for seed in range(seeds):
        objects = [make(rng, k, 10 ** (0.2 * (unit_mag - (limit + rng.uniform(-1.2, 1.2))))) for k in range(60)]
        path = write(directory, scenario_of(objects, exposure_s, sky, seed + 1, frames))
        _, truth, detections = run(binary, path, directory / "limit")
        for t in truth:
            if not t["in_frame"] or not t["whole"]:
                continue
            x, y = t["rendered_px"]
            near = any(d["frame"] == t["frame"] and math.hypot(d["x_px"] - x, d["y_px"] - y) < 3 for d in detections)
            magnitudes.append(t["true_magnitude"])
            found.append(near)
    measured = half_found(magnitudes, found)
    check(len(found) > 150 and abs(measured - limit) < 0.35,
          f"{name}: half of {len(found)} are found at V = {measured:.2f}, told {limit:.2f}")
    at = [f for m, f in zip(magnitudes, found) if abs(m - limit) < 0.25]
    check(0.1 < sum(at) / len(at) < 0.95, f"{name}: {sum(at)} of {len(at)} found within 0.25 mag of the limit")


def fixed_point(rng, number, radius_m):
    """On the geostationary distance, fixed over the site: stars trail, it does not."""
    place = EarthLocation.from_geodetic(SITE[1] * u.deg, SITE[0] * u.deg, SITE[2] * u.m)
    here = np.array([place.x.to_value(u.m), place.y.to_value(u.m), place.z.to_value(u.m)])
    direction = itrs_direction(SITE[0], SITE[1], rng.uniform(0, 360), 90 - 3.6 * math.sqrt(rng.random()))
    x = here + 3.8e7 * direction
    return (f"  - {{name: p{number}, radius_m: {radius_m!r}, "
            f"motion: {{fixed: {{itrs_m: [{', '.join(repr(float(c)) for c in x)}]}}}}}}\n")


def crossing(rng, number, radius_m):
    """1000 km overhead, eastwards at orbital speed."""
    t = Time(START.rstrip("Z"), scale="utc")
    place = EarthLocation.from_geodetic(SITE[1] * u.deg, SITE[0] * u.deg, SITE[2] * u.m)
    here = np.array([place.x.to_value(u.m), place.y.to_value(u.m), place.z.to_value(u.m)])
    direction = itrs_direction(SITE[0], SITE[1], rng.uniform(0, 360), 90 - 3.2 * math.sqrt(rng.random()))
    place_itrs = here + 1e6 * direction
    gcrs = ITRS(CartesianRepresentation(*place_itrs * u.m), obstime=t).transform_to(GCRS(obstime=t)).cartesian.xyz.to_value(u.m)
    east = np.cross([0.0, 0.0, 1.0], gcrs)
    v = 7350.0 * east / np.linalg.norm(east)
    numbers = lambda w: ", ".join(repr(float(c)) for c in w)
    return (f"  - {{name: s{number}, radius_m: {radius_m!r}, motion: {{two_body: {{position_m: [{numbers(gcrs)}], "
            f"velocity_m_per_s: [{numbers(v)}]}}}}}}\n")


def limits(binary, directory):
    point, streak = "found_point_v_mag", "streak_limit_v_mag"
    completeness(binary, directory, fixed_point, "points beside short trails, dark sky", point, 8.0, 21.9, 3, 2)
    completeness(binary, directory, fixed_point, "points beside long trails, bright sky", point, 25.0, 20.0, 3, 2)
    completeness(binary, directory, crossing, "streaks, dark sky", streak, 1.0, 21.9, 1, 5)
    completeness(binary, directory, crossing, "streaks, bright sky", streak, 0.8, 18.0, 1, 5)


def definitions(binary, directory):
    """What check prints of a sensor says of which light its limits are."""
    done = subprocess.run([binary, "check", write(directory, scenario_of([crossing(random.Random(1), 0, 1.0)], 1.0, 21.9, 1, 1))],
                          capture_output=True, text=True, check=True)
    point, streak = (re.search(words, done.stdout) for words in
                     (r"limiting magnitude V = [\d.]+ \(a point at .*\)", r"half of the streaks .* px, by their whole light\)"))
    check(point and streak and "in a pixel" not in done.stdout, f"limits are defined: {streak and streak[0]}")
    check(" 1 sensor, " in done.stdout and " 1 object, " in done.stdout, done.stdout.splitlines()[-1])


def warned(binary, directory):
    """Each slip that is asked about is warned of, and a good scenario is not."""
    good = (simulation("2018-01-21T00:15:00Z", duration_s=20) + "objects: [{name: thing, motion: {two_body: "
            "{semi_major_axis_m: 7178000, eccentricity: 0, inclination_deg: 50}}}]\nsensors:\n"
            "  - {name: eye, site: atlanta, pointing: zenith, exposure_s: 1, cadence_s: 5, sky: 21.9, effects: {objects: on},\n"
            f"     camera: {camera()}}}\n")
    cases = [("7178000", "7178", "semi_major_axis_m: the orbit is inside the Earth"),
             ("7178000", "6000000", "semi_major_axis_m: the orbit is inside the Earth"),
             ("pixel_pitch_m: 1.0e-5", "pixel_pitch_m: 13.5", "pixel_pitch_m: is unusual"),
             ("field_of_view_deg: 10.0", "focal_length_m: 400", "focal_length_m: is unusual"),
             ("aperture_m: 0.05", "aperture_m: 50.0", "aperture_m: is unusual"),
             ("pointing: zenith", "pointing: {azimuth_deg: 0, elevation_deg: -10}", "points below the horizon"),
             ("pointing: zenith", "pointing: {target: thing}", "below the horizon"),
             ("2018-01-21T00:15:00Z", "2018-01-21T17:15:00Z", "it is day"),
             ("sky: 21.9", "sky: 2.0", "saturate the pixels"),
             ("pointing: zenith", "pointing: {azimuth_deg: 200, elevation_deg: 40}", "no lit object is in the field")]
    for text, slip, warning in cases:
        assert text in good, text
        said = forecast(binary, write(directory, good.replace(text, slip, 1)))["warnings"]
        check(any(warning in line and "scenario.yaml:" in line for line in said), f"{slip}: {said}")
    old = good.replace("objects: [{", "objects: [{catalogue: demo}, {").replace("2018-01-21", "2024-01-21")
    check(any("from the start of the run" in w for w in forecast(binary, write(directory, old))["warnings"]),
          "elements years from the run are warned of")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory(prefix="dmise-test-") as folder:
        program = str(pathlib.Path(sys.argv[1]).resolve())
        for test in (fields_of_view, elevations, definitions, warned, counts, limits):
            test(program, pathlib.Path(folder))
