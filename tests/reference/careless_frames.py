"""Frames as other cameras and programs write them: is each read as it is meant?

    careless_frames.py DMISE [--keep DIR]

Draws a frame of stars and one streak with numpy, writes it with astropy in the ways of other cameras (mosaics of dyes, padded
counts, careless headers, dates, sites, settings, broad trails, defects), runs `dmise detect --catalogue none --report` on each and
prints a table of what is right. Where `../shared/cases/make_cases.py` and `validation/frames` of the data are there, their frames
are judged in the same way. Fails if one is wrong.
"""

import json
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile

try:
    import numpy as np
    from astropy.io import fits
except ImportError:
    print("skipped: needs numpy and astropy")
    sys.exit(77)

SOURCE = pathlib.Path(__file__).resolve().parents[2]
DATA = pathlib.Path(os.environ.get("DMISE_DATA", SOURCE.parent / "shared" / "data"))
CASES = SOURCE.parent / "shared" / "cases"
STREAK = (818.9, 525.4)  # middle of the one streak, from 0
TURN = 0.4  # angle of broad trails to the rows [rad]


def add_star(light, x, y, flux):
    row, column = max(int(y) - 12, 0), max(int(x) - 12, 0)
    cut = light[row:row + 25, column:column + 25]
    v, u = np.mgrid[row:row + cut.shape[0], column:column + cut.shape[1]]
    cut += flux / (2 * np.pi * 1.69) * np.exp(-((u - x) ** 2 + (v - y) ** 2) / 3.38)


def sky_and_stars():
    """Electrons of 400 stars of sigma 1.3 px over a sky that rises by a half."""
    random = np.random.default_rng(1)
    light = np.tile(50.0 + 40.0 * np.arange(1024) / 1024, (1024, 1))
    for _ in range(400):
        x, y, flux = random.uniform(0, 1024), random.uniform(0, 1024), 10 ** random.uniform(2.6, 4.6)
        if np.hypot(x - STREAK[0], y - STREAK[1]) > 60:
            add_star(light, x, y, flux)
    return light


def with_streak(light, e_per_px=2500.0, first_px=-29.0, last_px=29.0, factor=lambda along: 1.0):
    light = light.copy()
    for along in np.arange(first_px, last_px, 0.1):
        add_star(light, STREAK[0] + along * np.cos(0.7), STREAK[1] + along * np.sin(0.7), 0.1 * e_per_px * factor(along))
    return light


def exposed(light, seed=3):
    """Counts of one electron, read noise 4, bias 500."""
    random = np.random.default_rng(seed)
    return np.round(500 + random.poisson(light) + random.normal(0, 4, light.shape))


HEADER = {"DATE-OBS": "2018-01-21T01:02:00.000000", "EXPTIME": 2.0, "EGAIN": 1.0, "SITELAT": 33.777, "SITELONG": -84.398,
          "SITEELEV": 300.0}


def header_of(cards):
    header = fits.Header()
    for key, value in cards.items():
        if value is not None:
            header[key] = value
    return header


def own_frames(out):
    """Writes our own frames."""
    sky = sky_and_stars()
    counts = exposed(with_streak(sky))
    random = np.random.default_rng(2)

    def save(name, pixels, **change):
        cards = header_of({**HEADER, **{key.replace("_", "-"): value for key, value in change.items()}})
        fits.PrimaryHDU(np.clip(np.round(pixels), 0, 65535).astype(np.uint16), cards).writeto(out / f"{name}.fits", overwrite=True)

    save("plain", counts)
    dye = np.ones_like(counts)
    dye[0::2, 0::2], dye[1::2, 1::2] = 0.55, 0.45
    electrons = np.clip(counts - 500, 0, None).astype(int)
    mosaic = np.where(dye < 1, random.binomial(electrons, dye), electrons) + 500.0
    save("mosaic", mosaic, BAYERPAT="RGGB")
    save("mosaic-no-gain", mosaic, BAYERPAT="RGGB", EGAIN=None)
    step = 1.4826 * np.median(np.abs(counts - np.median(counts))) / 0.45
    coarse = np.round((counts - np.median(counts)) / step + 100)
    save("unpadded", coarse, EGAIN=step)
    save("padded", coarse * 16, EGAIN=step / 16)
    save("offset", counts, DATE_OBS="2018-01-20T18:02:00.317-0700")
    save("two-cards", counts, DATE_OBS="2018-01-21", UT="01:02:00.25")
    save("time-obs", counts, DATE_OBS="2018-01-21", TIME_OBS="01:02:00.25")
    save("old-date", counts, DATE_OBS="21/01/98", TIME_OBS="01:02:00")
    save("coarse", counts, DATE_OBS=None, MJD_OBS=58139.043)
    for setting in (10, 20):
        save(f"setting-{setting}", counts, EGAIN=None, GAIN=setting)
    nowhere = {"SITELAT": None, "SITELONG": None, "SITEELEV": None}
    save("sharpcap", counts, **nowhere, OBSLAT=33.777, OBSLONG=-84.398)
    save("latitude", counts, **nowhere, LATITUDE="+33:46:37", LONGITUD="-84:23:53", ALTITUDE=300.0)
    save("four-parts", counts, SITELAT="+33:46:37:20", SITELONG="-84:23:52:80")
    glow = counts.copy()
    glow[:, 0] += 90
    glow[:, 1] += 35
    save("edge", glow)
    scanned = counts.copy()
    scanned[:, 960:] = 500 + random.normal(0, 4, (1024, 64))
    save("overscan", scanned, DATASEC="[1:960,1:1024]")
    hot = counts.copy()
    hot[random.integers(0, 1024, 200), random.integers(0, 1024, 200)] += random.exponential(3000, 200)
    save("hot", hot)
    steps = 1 + random.normal(0.0, 0.4, 20)
    bright = with_streak(sky, 20000.0, factor=lambda along: max(steps[int((along + 40) / 4)], 0.05))
    save("flicker", exposed(bright))
    planes = [exposed(with_streak(sky, 20000.0, -29 + 7.25 * k, -29 + 7.25 * (k + 1)), 10 + k) for k in range(8)]
    save("maxima", np.maximum.reduce(planes))
    raw = (out / "plain.fits").read_bytes()
    write_headers(raw, counts.size * 2, out)
    for width in (3.5, 5, 7, 10, 14):
        for inside in (False, True):
            save_broad(width, inside, out)


def write_headers(raw, data_bytes, out):
    start = len(raw) - (data_bytes + 2879) // 2880 * 2880

    def with_card(name, card):
        cards = raw[:start]
        end = cards.index(b"END" + b" " * 77)
        body = cards[:end] + card.ljust(80)[:80] + b"END" + b" " * 77
        (out / f"{name}.fits").write_bytes(body + b" " * (-len(body) % 2880) + raw[start:])

    with_card("degree", "CCD-TEMP=                -10.0 / chip temperature, °C".encode("latin1"))
    with_card("accent", "OBSERVER= 'Peña'".encode())
    with_card("tab", b"HISTORY made\twith a tab")
    with_card("nul", b"COMMENT a\x00byte")
    with_card("complex", b"SKEW    = (1.0, 2.0)           / complex")
    with_card("ruler", b"COMMENT ========================= camera =========================")
    with_card("long-number", b"LONGNUM = 3.14159265358979323846264338327950288419716939937510")
    (out / "unpadded-file.fits").write_bytes(raw[:start + data_bytes])
    (out / "zero-block.fits").write_bytes(raw + b"\0" * 2880)


def save_broad(width, inside, out):
    y, x = np.mgrid[0:512, 0:512]
    random = np.random.default_rng(11)
    sky = np.full((512, 512), 1000.0)
    for _ in range(120):
        sx, sy = random.uniform(0, 512, 2)
        sky += 10 ** random.uniform(2, 4.3) / (2 * np.pi * 2.25) * np.exp(-((x - sx) ** 2 + (y - sy) ** 2) / 4.5)
    across = (y - 256) * np.cos(TURN) - (x - 256) * np.sin(TURN)
    along = (x - 256) * np.cos(TURN) + (y - 256) * np.sin(TURN)
    lit = (np.abs(across) < width / 2) & (np.abs(along) < (120 if inside else 1e9))
    counts = random.poisson(sky + 10 * np.sqrt(1000.0) * lit)
    cards = header_of({"DATE-OBS": "2021-05-01T04:00:00", "EXPTIME": 2.0, "EGAIN": 1.0})
    name = f"broad-{width}-{'ends' if inside else 'crosses'}"
    fits.PrimaryHDU(counts.astype(np.uint16), cards).writeto(out / f"{name}.fits", overwrite=True)


class Seen:
    """What the program says of a frame."""

    def __init__(self, dmise, path):
        self.dmise, self.path = dmise, path
        run = subprocess.run([dmise, "detect", str(path), "--catalogue", "none", "--report"], capture_output=True, text=True,
                             timeout=600, check=False)
        self.code, self.notes = run.returncode, run.stderr
        lines = [json.loads(line) for line in run.stdout.splitlines()]
        self.report = lines[0] if lines else {}
        self.found = lines[1:]

    def noted(self, begin):
        """The first note that begins so, without its file."""
        for line in self.notes.splitlines():
            at = line.find(begin)
            if at >= 0:
                return line[at:]
        return ""


def one_streak(seen):
    if len(seen.found) != 1:
        return f"{len(seen.found)} detections"
    x, y = seen.found[0]["x_px"], seen.found[0]["y_px"]
    return "" if abs(x - STREAK[0]) < 1 and abs(y - STREAK[1]) < 1 else f"streak at {x:.1f} {y:.1f}"


def as_unpadded(seen):
    """The same noise in electrons, and the same stars."""
    plain = Seen(seen.dmise, seen.path.with_name("unpadded.fits")).report
    differ = [f"{key} {seen.report[key]} of {plain[key]}" for key in ("noise_e", "psf_stars", "star_like")
              if not math.isclose(seen.report[key], plain[key], rel_tol=1e-6)]
    return one_streak(seen) or ", ".join(differ)


def gain_near(least, most):
    def judge(seen):
        measured = re.search(r"gain: ([0-9.]+) \+-", seen.notes)
        if not measured:
            return "gain not measured"
        gain = float(measured[1])
        return one_streak(seen) or ("" if least <= gain <= most else f"gain {gain}")

    return judge


def start_is(utc):
    return lambda seen: one_streak(seen) or ("" if str(seen.report["start_utc"]).startswith(utc)
                                             else f"start {seen.report['start_utc']}")


def names_card(card):
    return lambda seen: one_streak(seen) or ("" if card in seen.notes else "no note names the card")


def no_better_than_a_minute(seen):
    if "86.4 s" not in seen.noted("time: the last digit"):
        return "no note of the width"
    return one_streak(seen) or ("" if "." not in seen.report["start_utc"] else f"claims {seen.report['start_utc']}")


def site_known(seen):
    return one_streak(seen) or ("" if seen.report["sensor_position_gcrs_m"] else "no site")


def nothing(seen):
    return f"{len(seen.found)} detections" if seen.found else ""


def broad(inside):
    def judge(seen):
        if len(seen.found) != 1:
            return f"{len(seen.found)} detections"
        one = seen.found[0]
        off = abs((one["y_px"] - 256) * np.cos(TURN) - (one["x_px"] - 256) * np.sin(TURN))
        if one["kind"] != "streak" or off > 2:
            return f"{one['kind']} {off:.1f} px beside it"
        length = one["length_px"]
        return "" if (abs(length - 240) < 12 if inside else length > 500) else f"{length:.0f} px long"

    return judge


JUDGES = {
    "plain": one_streak, "mosaic": one_streak, "mosaic-no-gain": gain_near(0.9, 1.1),
    "unpadded": one_streak, "padded": as_unpadded,
    "degree": names_card("CCD-TEMP"), "accent": names_card("OBSERVER"), "tab": names_card("HISTORY"), "nul": names_card("COMMENT"),
    "complex": one_streak, "ruler": one_streak, "long-number": one_streak, "unpadded-file": one_streak, "zero-block": one_streak,
    "offset": start_is("2018-01-21T01:02:00.317"), "two-cards": start_is("2018-01-21T01:02:00.25"),
    "time-obs": start_is("2018-01-21T01:02:00.25"), "old-date": start_is("1998-01-21T01:02:00"),
    "coarse": no_better_than_a_minute, "setting-10": gain_near(0.94, 1.15), "setting-20": gain_near(0.94, 1.15),
    "sharpcap": site_known, "latitude": site_known, "four-parts": site_known, "edge": one_streak, "overscan": one_streak,
    "hot": one_streak, "flicker": one_streak, "maxima": one_streak, "edge-small": nothing,
}
for _width in (3.5, 5, 7, 10, 14):
    JUDGES[f"broad-{_width}-crosses"] = broad(False)
    JUDGES[f"broad-{_width}-ends"] = broad(True)

REAL = {  # frames of survey telescopes: what their catalogue says of them
    "cutout_HSCA21787010": lambda seen: ("" if len(seen.found) == 1 and seen.found[0]["kind"] == "streak" else
                                         f"{len(seen.found)} detections") or
    ("" if str(seen.report["start_utc"]).startswith("2020-05-28T14:32:17.953") else f"start {seen.report['start_utc']}"),
    "cutout_frame-i-008108-5-0025": lambda seen: nothing(seen) or
    ("" if str(seen.report["start_utc"]).startswith("2009-10-17T01:52:36.59") else f"start {seen.report['start_utc']}"),
    "cutout_lbcb.20210407.120357": lambda seen: "" if seen.code == 0 else "refused",
    "cutout_m20211212UT_image0110.new": lambda seen: "" if any(d["kind"] == "streak" for d in seen.found) else "no trail",
}


def judge_all(dmise, frames, where, table):
    for name, path in frames:
        judge = JUDGES.get(name) or REAL.get(name)
        seen = Seen(dmise, path)
        fault = f"refused: {seen.notes.strip().splitlines()[-1:]}" if seen.code else judge(seen) if judge else "nothing says what is right"
        table.append((where, name, fault))
        print(f"{where:8} {name:34} {'right' if not fault else 'WRONG: ' + fault}", flush=True)


def frames_of(folder):
    return [(path.name.removesuffix(".gz").removesuffix(".fits"), path) for path in sorted(folder.glob("*.fits*"))]


def main():
    dmise = sys.argv[1]
    table = []
    with tempfile.TemporaryDirectory() as held:
        out = pathlib.Path(sys.argv[sys.argv.index("--keep") + 1]) if "--keep" in sys.argv else pathlib.Path(held) / "own"
        out.mkdir(parents=True, exist_ok=True)
        own_frames(out)
        judge_all(dmise, frames_of(out), "own", table)
        if (CASES / "make_cases.py").exists():
            others = pathlib.Path(held) / "cases"
            subprocess.run([sys.executable, str(CASES / "make_cases.py"), str(others)], check=True, capture_output=True)
            judge_all(dmise, frames_of(others), "cases", table)
            judge_all(dmise, [("edge-small", CASES / "edge-small.fits")], "cases", table)
        if (DATA / "validation" / "frames").exists():
            judge_all(dmise, frames_of(DATA / "validation" / "frames"), "real", table)
    wrong = sum(bool(fault) for _, _, fault in table)
    print(f"{len(table) - wrong} of {len(table)} right")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
