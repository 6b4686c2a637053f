"""Readers of other people read what `dmise export` writes of a small run: ccsds-ndm the messages of CCSDS, sgp4 element sets,
pycocotools COCO, csv tables, regions region files of DS9; SatSim computes SatNet's annotations, the Unified Data Library's own client lists its fields.

    read_exports.py DMISE
"""

import ast
import csv
import importlib.util
import io
import json
import math
import pathlib
import subprocess
import sys
import types
import warnings

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests/system"), str(ROOT / "tests/reference")]
from harness import check, main  # noqa: E402

try:
    import numpy as np
    import pycocotools.coco
    import pycocotools.cocoeval
    import regions
    import sgp4.omm
    from astropy.io import fits
    from astropy.wcs import WCS
    from ccsds_ndm.ndm_io import NdmIo
    from sgp4.api import Satrec
    PACKAGES = {name: pathlib.Path(importlib.util.find_spec(name).origin).parent
                for name in ("satsim", "unifieddatalibrary")}
except (ImportError, AttributeError) as missing:
    print(f"skipped: {missing} (./dmise setup --tests)")
    sys.exit(77)

SCENARIO = """simulation: {start: 2018-01-21T00:15:00Z, duration_s: 60, tick_s: 5, seed: 1}
objects: [{catalogue: demo}]
stars: {catalogue: kstars}
sensors:
  - {name: metop, platform: "29499", camera: wide-field-cmos, pointing: {ra_deg: 85.2, dec_deg: 0.7}, exposure_s: 2, cadence_s: 15, sky: space}
  - {name: savannah, site: savannah, camera: geo-watch, pointing: {azimuth_deg: 168.7, elevation_deg: 52}, exposure_s: 5, cadence_s: 30, sky: suburban}
output: {png: false}
"""
LIGHT_KM_PER_S = 299792.458


def lines(path):
    return [json.loads(line) for line in path.read_text().splitlines()]


def unit(ra_deg, dec_deg):
    ra, dec = np.radians([ra_deg, dec_deg])
    return np.array([math.cos(dec) * math.cos(ra), math.cos(dec) * math.sin(ra), math.sin(dec)])


def observations(segment):
    """Angles and magnitude of a segment by time tag."""
    out = {}
    for o in segment.data.observation:
        for key in ("angle_1", "angle_2", "mag"):
            value = getattr(o, key)
            if value is not None:
                out.setdefault(o.epoch, {})[key] = getattr(value, "value", value)
    return out


def read_tdm(path, detections, states, frames):
    segments = NdmIo().from_path(path["tdm", "detections"]).body.segment
    check(len(segments) == len(detections) > 20, f"ccsds-ndm reads {len(segments)} segments, one a detection")
    for s, d in zip(segments, detections):
        m = s.metadata
        (time, o), = observations(s).items()
        good = (m.track_id == d["id"] and m.participant_1 == d["sensor"] and m.time_system == "UTC" and m.path == "2,1" and
                m.angle_type.value == "RADEC" and m.reference_frame.value == "ICRF" and m.timetag_ref.value == "RECEIVE" and
                m.integration_ref.value == "MIDDLE" and m.corrections_applied.value == "YES" and
                time[:26] == d["time_utc"][:26])
        close = (abs(o["angle_1"] - d["corrected_ra_deg"]) < 1e-9 and abs(o["angle_2"] - d["corrected_dec_deg"]) < 1e-9 and
                 abs(o["mag"] - d["magnitude"]) < 1e-6 and
                 abs(o["angle_1"] - m.correction_angle_1 - d["ra_deg"]) < 2e-9 and
                 abs(o["angle_2"] - m.correction_angle_2 - d["dec_deg"]) < 2e-9)
        if not (good and close):
            check(False, f"segment of {d['id']}: {m} {o}")
    check(True, "angles, magnitudes, corrections and time tags are those of the detections")
    # Truth: from the states of the OEM, one light time back, seen from the sensor.
    segments, worst, count = NdmIo().from_path(path["tdm", "truth"]).body.segment, 0.0, 0
    pairs = [(s.metadata.participant_1, s.metadata.participant_2) for s in segments]
    check(len(set(pairs)) == len(pairs), "truth has one segment for each pair of sensor and object")
    for s in segments:
        for time, o in observations(s).items():
            position, velocity = states[s.metadata.participant_2][time]
            sensor = frames[s.metadata.participant_1, time[:26]]
            away = position - sensor
            seen = away - velocity * np.linalg.norm(away) / LIGHT_KM_PER_S
            error = np.linalg.norm(seen / np.linalg.norm(seen) - unit(o["angle_1"], o["angle_2"]))
            worst, count = max(worst, math.degrees(error) * 3.6e6), count + 1
    check(count > 20 and worst < 2.0, f"{count} true directions are those of the OEM's states within {worst:.3f} mas")


def read_oem(path, truths):
    states = {}
    for s in NdmIo().from_path(path["oem", "truth"]).body.segment:
        m = s.metadata
        check_quietly(m.ref_frame == "GCRF" and m.time_system == "UTC" and m.center_name == "EARTH", m)
        for v in s.data.state_vector:
            states.setdefault(m.object_id, {})[v.epoch] = (np.array([v.x.value, v.y.value, v.z.value]),
                                                           np.array([v.x_dot.value, v.y_dot.value, v.z_dot.value]))
    wanted = {(str(t["catalogue_number"]), t["middle_utc"][:26]): t for t in truths}
    found = {(number, time[:26]): s for number, of in states.items() for time, s in of.items()}
    check(set(found) == set(wanted), f"ccsds-ndm reads {len(found)} states, one for each object and time")
    worst = max(float(np.abs(found[k][0] - np.array(t["true_position_gcrs_m"]) / 1e3).max()) for k, t in wanted.items())
    check(worst <= 1e-9, "positions lose less than a micrometre")
    return states


def check_quietly(holds, claim):
    if not holds:
        check(False, str(claim))


def read_omm(path):
    from skyfield_directions import read_elements
    import referee
    elements = read_elements(referee.CATALOGUES / "demo.tle")
    check(len(NdmIo().from_path(path["omm", "truth"]).omm) == len(elements), f"ccsds-ndm reads {len(elements)} OMM")
    worst, count = 0.0, 0  # its epochs of OMM are days since 1949 in a double: 0.3 us, 2.4 mm
    for fields in sgp4.omm.parse_xml(open(path["omm", "truth"], encoding="utf-8")):
        ours = Satrec()
        sgp4.omm.initialize(ours, fields)
        theirs = Satrec.twoline2rv(*elements[int(fields["NORAD_CAT_ID"])])
        a, b = (s.sgp4(s.jdsatepoch, s.jdsatepochF + 0.1) for s in (ours, theirs))
        if a[0] == b[0] == 0:
            later = (ours.jdsatepoch - theirs.jdsatepoch) + (ours.jdsatepochF - theirs.jdsatepochF)
            moved = np.array(a[1]) - np.array(b[1]) - np.array(b[2]) * later * 86400
            worst, count = max(worst, float(np.linalg.norm(moved)) * 1e6), count + 1
    check(count > 900 and worst < 4.0, f"sgp4 gives {count} orbits of OMM and TLE the same place within {worst:.3f} mm")


def satsim_annotation():
    """SatSim's own function, without the packages of its renderer."""
    for name in ("tensorflow", "tifffile", "satsim", "satsim.io", "satsim.io.fits", "satsim.io.image", "satsim.config",
                 "satsim.geometry", "satsim.geometry.transform", "satsim.image", "satsim.image.coordinates"):
        sys.modules[name] = types.ModuleType(name)
    sys.modules["satsim.io"].fits = sys.modules["satsim.io"].image = None
    sys.modules["satsim.config"].save_json = None
    sys.modules["satsim.geometry.transform"].rotate_and_translate = None
    sys.modules["satsim.image.coordinates"].oversampled_to_detector = None
    spec = importlib.util.spec_from_file_location("satnet", PACKAGES["satsim"] / "io/satnet.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module._annotate_object


def read_satnet(path, run, truths, frames):
    annotate, count = satsim_annotation(), 0
    for f in frames:
        stem = f"{f['sensor']}.{f['frame']:04d}"
        folder = path["satnet", "truth"] / f["sensor"]
        data = json.loads((folder / f"Annotations/{stem}.json").read_text())["data"]
        check_quietly((folder / f"ImageFiles/{data['file']['filename']}").read_bytes() ==
                      (run / f["sensor"] / f"frame-{f['frame']:06d}.fits").read_bytes(), f"{stem} has its image")
        height, width = data["sensor"]["height"], data["sensor"]["width"]
        here = [t for t in truths if (t["sensor"], t["frame"]) == (f["sensor"], f["frame"]) and t["in_frame"]]
        check_quietly(len(here) == len(data["objects"]), f"{stem} has its objects")
        for t, o in zip(here, data["objects"]):
            if not t["whole"]:
                continue
            rows, columns = (np.array([t[k][axis] for k in ("start_px", "middle_px", "end_px")]) for axis in (1, 0))
            pad = (o["bbox_width"] - (o["x_max"] - o["x_min"])) * width / 2
            theirs = annotate(height, width, rows, columns, t["true_magnitude"], o["pe_per_sec"], box_pad=pad, seg_id=o["seg_id"],
                              object_name=t["name"], object_id=str(t["catalogue_number"]))
            count += 1
            for key, value in theirs.items():
                same = key == "source" or (abs(o[key] - value) < 1e-12 if isinstance(value, float) else o[key] == value)
                check_quietly(same, f"{stem} {t['name']}: {key}: {o[key]}, SatSim has {value}")
    check(count > 10, f"SatNet: {count} annotations are what SatSim computes of the truth's pixels")


def read_coco(path, truths, detections):
    sys.stdout, out = io.StringIO(), sys.stdout
    try:
        coco = pycocotools.coco.COCO(path["coco", "truth"])
        found = coco.loadRes(str(path["coco", "detections"]))
        judge = pycocotools.cocoeval.COCOeval(coco, found, "bbox")
        judge.params.iouThrs = np.array([0.5])
        judge.params.maxDets = [1, 100, 1000]
        judge.evaluate()
        judge.accumulate()
    finally:
        sys.stdout = out
    lit = [t for t in truths if t["in_frame"]]
    annotations = coco.loadAnns(coco.getAnnIds())
    check(len(annotations) == len(lit), f"pycocotools reads {len(annotations)} annotations, one for each lit object")
    worst_area, outside = 0.0, []
    for a, t in zip(annotations, lit):
        mask = coco.annToMask(a)
        x, y = t["rendered_px"]
        ys, xs = np.nonzero(mask)
        if not mask[round(y), round(x)]:
            outside.append(t["name"])
        left, top, w, h = a["bbox"]
        check_quietly(xs.min() + 0.5 >= left - 1 and xs.max() + 0.5 <= left + w + 1, f"box of {t['name']}")
        check_quietly(ys.min() + 0.5 >= top - 1 and ys.max() + 0.5 <= top + h + 1, f"box of {t['name']}")
        if t["whole"]:  # the centre of the mask is that of the trail
            middle = (np.array(t["start_px"]) + np.array(t["end_px"])) / 2
            centre = np.array([xs.mean(), ys.mean()])
            check_quietly(np.abs(centre - middle).max() < 0.75, f"mask of {t['name']}: {centre}, trail {middle}")
        worst_area = max(worst_area, abs(mask.sum() / a["area"] - 1))
    check(not outside, f"the light of each is in its mask {outside}")
    check(worst_area < 0.1, f"areas are those of the masks within {worst_area:.3f}")
    recall = float(judge.eval["recall"][0, 0, 0, -1])
    share = sum(d["sensor"] == "metop" for d in detections) / len(lit)
    check(recall > 0.6 * min(1.0, share), f"COCOeval finds {recall:.2f} of the objects in the results (IoU 0.5)")


def read_csv(path, run):
    for name in ("detections", "frames"):
        with open(path["csv", "detections"] / f"{name}.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        wanted = lines(run / f"{name}.jsonl")
        check(len(rows) == len(wanted), f"{name}.csv has {len(rows)} rows")
        for row, line in zip(rows, wanted):
            for key, value in line.items():
                if isinstance(value, (int, float)) and not isinstance(value, bool):
                    check_quietly(float(row[key]) == value, f"{name}.csv: {key}")
                if isinstance(value, str):
                    check_quietly(row[key] == value, f"{name}.csv: {key}")
        check(True, f"numbers of {name}.csv are those of the lines to the bit")


def udl_fields():
    """Names, types and whether they must be there, from the source of the library's client."""
    source = (PACKAGES["unifieddatalibrary"] / "types/observations/eo_observation_create_bulk_params.py").read_text()
    body, = (c for c in ast.parse(source).body if isinstance(c, ast.ClassDef) and c.name == "Body")
    fields = {}
    for item in body.body:
        if isinstance(item, ast.AnnAssign):
            text = ast.unparse(item.annotation)
            alias = text.split("alias='")[1].split("'")[0] if "alias='" in text else item.target.id
            fields[alias] = text
    return fields


def read_udl(path, detections):
    fields = udl_fields()
    required = {k for k, text in fields.items() if text.startswith("Required")}
    for kind in ("detections", "truth"):
        records = json.loads(path["udl", kind].read_text())
        for r in records:
            for key, value in r.items():
                text = fields.get(key, "")
                good = ("float" in text and isinstance(value, (int, float)) or "bool" in text and isinstance(value, bool) or
                        "int" in text and isinstance(value, int) or "Literal" in text and f"'{value}'" in text or
                        "str" in text and isinstance(value, str))
                check_quietly(good, f"{key}: {value} is not {text or 'a field'}")
            check_quietly(required <= set(r), f"{required - set(r)} is missing")
        check(len(records) > 20, f"{len(records)} EOObservations of {kind} have fields and types of the library's client")
    for r, d in zip(json.loads(path["udl", "detections"].read_text()), detections):
        check_quietly(abs(r["ra"] - d["corrected_ra_deg"]) < 1e-12 and r["obTime"][:26] == d["time_utc"][:26] and
                      abs(r["senx"] * 1e3 - d["sensor_position_gcrs_m"][0]) < 1e-6, d["id"])
        sigma = math.sqrt(d["covariance_arcsec2"][0]) / 3600 / math.cos(math.radians(d["corrected_dec_deg"]))
        check_quietly(abs(r["raUnc"] / sigma - 1) < 1e-9, f"{d['id']}: sigma of right ascension")


def read_czml(path, run, truths, frames):
    packets = json.loads(path["czml", "truth"].read_text())
    names = [p["id"] for p in packets]
    check(names[0] == "document" and packets[0]["version"] == "1.0" and len(set(names)) == len(names), f"CZML has {len(names)} packets")
    check("agi_" not in path["czml", "truth"].read_text(), "and no extension of one program")
    start = packets[0]["clock"]["interval"].split("/")[0]
    by_name = dict(zip(names, packets))
    # Objects: where truth has them, in the inertial frame.
    for t in truths:
        p = by_name[f"object/{t['catalogue_number']}"]["position"]
        check_quietly(p["referenceFrame"] == "INERTIAL" and p["epoch"] == start, t["name"])
        rows = np.array(p["cartesianVelocity"]).reshape(-1, 7)
        row = rows[np.argmin(abs(rows[:, 0] - t["middle_ns"] / 1e9))]
        check_quietly(np.linalg.norm(row[1:4] - t["true_position_gcrs_m"]) < 1e-3 and
                      np.linalg.norm(row[4:] - t["true_velocity_gcrs_m_per_s"]) < 1e-6 and np.all(np.diff(rows[:, 0]) > 0), t["name"])
    check(by_name["sensor/savannah"]["position"]["cartographicDegrees"][1] > 30 and
          by_name["sensor/metop"]["position"]["referenceFrame"] == "INERTIAL", "sensors are on the ground and in orbit")
    fields = [p for p in packets if "polyline" in p]
    check(len(fields) == len(frames), f"{len(fields)} fields of view, one a frame")
    for p in packets:
        for name in p.get("polyline", {}).get("positions", {}).get("references", []):
            check_quietly(name.endswith("#position") and "position" in by_name[name[:-9]], f"{name} is a packet's position")
    for f in frames:  # the corners of the field are the WCS's
        with warnings.catch_warnings(), fits.open(run / f["sensor"] / f"frame-{f['frame']:06}.fits") as file:
            warnings.simplefilter("ignore")
            world, shape = WCS(file[0].header, file), file[0].data.shape
        corner = world.all_pix2world([[shape[1] - 0.5, shape[0] - 0.5]], 0)[0]
        rows = np.array(by_name[f"field/{f['sensor']}/{f['frame']}/3"]["position"]["cartesianVelocity"]).reshape(-1, 7)
        check_quietly(len(rows) > 1, "between two states there is one at any time")
        at = rows[np.argmin(abs(rows[:, 0] - f["middle_ns"] / 1e9)), 1:4]
        line = at - f["sensor_position_gcrs_m"]
        angle = np.linalg.norm(line / np.linalg.norm(line) - unit(*corner))
        check_quietly(angle < 1e-6, f"corner of {f['sensor']}/{f['frame']} is off by {angle}")


def read_regions(path, run, truths, detections):
    directory = path["regions", "all"]
    for kind, rows in (("truth", [t for t in truths if t["in_frame"]]), ("detections", detections)):
        found = {"image": 0, "icrs": 0}
        for frame in sorted(directory.glob(f"*/*-{kind}.image.reg")):
            fits_file = run / frame.parent.name / (frame.name.split(f"-{kind}")[0] + ".fits")
            with warnings.catch_warnings(), fits.open(fits_file) as file:
                warnings.simplefilter("ignore")
                world = WCS(file[0].header, file)
            image, sky = (regions.Regions.read(name, format="ds9")
                          for name in (frame, frame.with_name(frame.name.replace(".image.", ".icrs."))))
            found["image"] += len(image)
            found["icrs"] += len(sky)
            for a, b in zip(image, sky):
                circle = isinstance(a, regions.CirclePixelRegion)
                place, direction = (a.center, b.center) if circle else (a.start, b.start)
                x, y = world.all_world2pix([[direction.ra.deg, direction.dec.deg]], 0, quiet=True)[0]
                inside = 0 <= place.x < world.pixel_shape[0] and 0 <= place.y < world.pixel_shape[1]
                check_quietly(not inside or math.hypot(x - place.x, y - place.y) < 0.02, f"{frame.name}: both coordinates are one place")
        check(found["image"] == found["icrs"] >= len(rows) > 20, f"{found['image']} regions of {len(rows)} {kind}, read by astropy's")
    d = next(d for d in detections if d["kind"] == "point") if any(d["kind"] == "point" for d in detections) else detections[0]
    name = f"{d['sensor']}/frame-{d['frame']:06}-detections.image.reg"
    first = regions.Regions.read(directory / name, format="ds9")
    places = [(r.center.x, r.center.y) if hasattr(r, "center") else (r.end.x, r.end.y) for r in first]
    check(min(math.hypot(x - d["x_px"], y - d["y_px"]) for x, y in places) < 1e-3, "a region is where its detection is")


def refusals(export, run):
    for arguments, words in ((("--to", "tdmm"), "did you mean tdm"), (("--to", "oem", "--detections"), "oem holds only truth"),
                             (("--to", "csv", "--sensor", "metopp"), "did you mean metop"),
                             (("--to", "omm", "--catalogue", "none.tle"), "none.tle")):
        text = export(*arguments, expect=2)
        check(words in text and text.count("\n") == 1, f"refused in one line: {text.strip()}")
    lost = run.parent / "lost"
    lost.mkdir()
    check("run.json: is missing" in export("--to", "tdm", run=lost, expect=2), "a directory that is no run is refused")


def test(binary, directory):
    (directory / "small.yaml").write_text(SCENARIO)
    run = directory / "run"
    subprocess.run([binary, "run", directory / "small.yaml", "--out", run], check=True, capture_output=True)

    def export(*arguments, run=run, expect=0):
        done = subprocess.run([binary, "export", run, *map(str, arguments)], capture_output=True, text=True, check=False)
        check_quietly(done.returncode == expect, f"export {arguments} exits with {expect}: {done.stderr}")
        return done.stderr

    path = {}
    for to, kind in (("tdm", "detections"), ("tdm", "truth"), ("oem", "truth"), ("omm", "truth"), ("satnet", "truth"),
                     ("coco", "truth"), ("coco", "detections"), ("csv", "detections"), ("udl", "detections"), ("udl", "truth"), ("czml", "truth")):
        path[to, kind] = directory / f"{to}-{kind}.out"
        export("--to", to, f"--{kind}", "--out", path[to, kind])
        if path[to, kind].is_file():
            again = directory / "again"
            export("--to", to, f"--{kind}", "--out", again)
            check_quietly(again.read_bytes() == path[to, kind].read_bytes(), f"{to}: the same bytes twice")
    truths, detections, frames = (lines(run / f"{name}.jsonl") for name in ("truth", "detections", "frames"))
    states = read_oem(path, truths)
    read_tdm(path, detections, states, {(f["sensor"], f["middle_utc"][:26]): np.array(f["sensor_position_gcrs_m"]) / 1e3
                                        for f in frames})
    read_omm(path)
    read_coco(path, truths, detections)
    read_csv(path, run)
    read_udl(path, detections)
    read_satnet(path, run, truths, frames)
    read_czml(path, run, truths, frames)
    path["regions", "all"] = directory / "regions"
    export("--to", "regions", "--out", path["regions", "all"])
    read_regions(path, run, truths, detections)
    refusals(export, run)


main(test)
