"""A night of KStars/Ekos with `dmise observatory --indi`: it connects, goes to fields and solves their frames, corrects a mount that
points wrongly, and follows a satellite for a minute.

    build/venv/bin/python bench/ekos_night.py [--binary build/release/bin/dmise] [--stars tycho2] [--out DIRECTORY]

Debian 12: apt-get install kstars xvfb openbox xdotool imagemagick dbus qdbus-qt5 libglib2.0-bin astrometry-data-tycho2-10-19. Stars are
Tycho-2's: `dmise catalogue fetch tycho2`. KStars runs on a display and a D-Bus session of its own, with a home in DIRECTORY; nothing
of the user's is read or written. Profile and optical train are written into its database before it starts. What Ekos has a
D-Bus method for is called by it; *Track satellite* is chosen by mouse and keys from the menu of the sky map, as KStars 3.6.2 has it.
Printed are the solved places (KStars tells places of its catalogues to 0.2 arcsec) against where the telescope was sent and
against the WCS of the frames, and where the satellite is in each frame. Screenshots lie in DIRECTORY: solved, corrected, menu, followed.
"""

import argparse
import ast
import json
import math
import os
import pathlib
import re
import signal
import sqlite3
import subprocess
import sys
import tempfile
import time
import warnings

import numpy
from astropy.io import fits
from astropy.wcs import WCS, FITSFixedWarning

ROOT = pathlib.Path(__file__).resolve().parents[1]
SENSOR = "telescope"
MOUNT, CAMERA = f"{SENSOR} telescope", f"{SENSOR} camera"
FIELDS = {"M 37": 1, "M 33": 1, "NGC 752": 1, "M 36": 2}  # with Ekos' binning
CLUSTER = "M 37"
SATELLITE = "ATLAS CENTAUR R/B"
APERTURE_MM, FOCAL_LENGTH_MM = 300, 600
START = "2018-01-21T00:49:40Z"
PASS_AFTER_S = 160.0  # the satellite is then 45 deg high
PASS_S = 70.0
SCENARIO = """\
simulation: {{start: {start}, duration_s: 28800, tick_s: 5, seed: 1}}
objects: [{{catalogue: demo}}]
stars: {{catalogue: {stars}, faintest_mag: 12, synthetic_to: 15}}
sensors:
  - name: telescope
    site: huntsville
    camera:
      name: telescope-0.3m
      optics: {{columns: 1024, rows: 1024, pixel_pitch_m: 13e-6, focal_length_m: 0.6, aperture_m: 0.3, obscuration: 0.4,
               transmission: 0.8, psf_fwhm_px: 1.8}}
      detector: {{quantum_efficiency: 0.9, dark_e_per_s: 0.1, dark_reference_c: -20, temperature_c: -20,
                 read_noise_e: 6, full_well_e: 90000, gain_e_per_dn: 1.4, bias_dn: 300, adc_bits: 16}}
      band: {{name: V, centre_m: 0.55e-6, width_m: 0.128e-6}}
    pointing: zenith
    exposure_s: 2
    cadence_s: 3600
    sky: suburban
    mask_deg: 10
output: {{png: false}}
"""
KSTARSRC = """\
[GUI]
RunStartupWizard=false
ShowStatusBar=false
[TipOfDay]
RunOnStart=false
[indi]
useKStarsSource=false
useMountSource=true
[View]
UseAnimatedSlewing=false
ShowDeepSky=false
[Satellites]
ShowSatellites=true
ShowVisibleSatellites=false
SelectedSatellites={satellite}
[FITSViewer]
useFITSViewer=false
[Ekos]
profile=dmise
[Align]
AlignExposure={exposure}
AlignBinning=1x1
"""
SEQUENCE = """\
<?xml version="1.0" encoding="UTF-8"?>
<SequenceQueue version='2'>
<GuideDeviation enabled='false'>2</GuideDeviation>
<Autofocus enabled='false'>0</Autofocus>
<Job>
<Exposure>{exposure}</Exposure>
<Binning><X>1</X><Y>1</Y></Binning>
<Frame><X>0</X><Y>0</Y><W>1024</W><H>1024</H></Frame>
<Temperature force='false'>0</Temperature>
<Type>Light</Type>
<Prefix><RawPrefix>pass</RawPrefix><FilterEnabled>0</FilterEnabled><ExpEnabled>0</ExpEnabled><TimeStampEnabled>0</TimeStampEnabled></Prefix>
<Count>{count}</Count>
<Delay>0</Delay>
<FITSDirectory>{directory}</FITSDirectory>
<UploadMode>0</UploadMode>
<Properties></Properties>
<Calibration><FlatSource><Type>Manual</Type></FlatSource><FlatDuration><Type>Manual</Type></FlatDuration>
<PreMountPark>False</PreMountPark><PreDomePark>False</PreDomePark></Calibration>
</Job>
</SequenceQueue>
"""
SCREEN = (1920, 1200)
EKOS_DONE, INDI_DONE = "2", "2"  # Ekos::CommunicationStatus: Idle, Pending, Success, Error
ALIGN_COMPLETE, ALIGN_FAILED, ALIGN_ABORTED = "1", "2", "3"  # Ekos::AlignState; all others are on the way
SOLVE_AND_SLEW, SOLVE_ONLY = 1, 2  # Ekos::Align::GotoMode


class Late(Exception):
    pass


def until(what, holds, patience_s, every_s=0.2):
    """What `holds` returns, once it is true; Late if it is not within `patience_s`."""
    end = time.monotonic() + patience_s
    while True:
        value = holds()
        if value:
            return value
        if time.monotonic() > end:
            raise Late(f"{what}: not within {patience_s} s")
        time.sleep(every_s)


def apart_arcsec(a, b):
    (ra1, dec1), (ra2, dec2) = ((math.radians(x) for x in place) for place in (a, b))
    half = math.sin((dec2 - dec1) / 2) ** 2 + math.cos(dec1) * math.cos(dec2) * math.sin((ra2 - ra1) / 2) ** 2
    return math.degrees(2 * math.asin(min(1.0, math.sqrt(half)))) * 3600


class Desktop:
    """A display with a window manager, a D-Bus session, and KStars in a home of its own."""

    def __init__(self, directory):
        self.directory, self.processes = directory, []
        self.home, temporary, runtime = directory / "home", directory / "tmp", directory / "run"
        for path in (self.home / ".config", self.home / ".local/share/kstars", temporary):
            path.mkdir(parents=True, exist_ok=True)
        runtime.mkdir(mode=0o700, exist_ok=True)
        # Ekos removes the FITS files that it finds in the directory of temporary files.
        self.environment = {name: value for name, value in os.environ.items() if not name.startswith(("XDG_", "KDE_", "QT_"))} | {
            "HOME": str(self.home), "TMPDIR": str(temporary), "XDG_RUNTIME_DIR": str(runtime), "TZ": "UTC", "LC_ALL": "C.UTF-8",
            "QT_QPA_PLATFORM": "xcb"}

    def start(self, *command, **options):
        process = subprocess.Popen([str(word) for word in command], env=self.environment, stdin=subprocess.DEVNULL,
                                   **({"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL} | options))
        self.processes.append(process)
        return process

    def open(self):
        read, write = os.pipe()
        self.start("Xvfb", "-displayfd", write, "-screen", "0", "{}x{}x24".format(*SCREEN), "-nolisten", "tcp", pass_fds=[write])
        os.close(write)
        with os.fdopen(read) as display:
            self.environment["DISPLAY"] = ":" + display.readline().strip()
        bus = self.start("dbus-daemon", "--session", "--nofork", "--print-address=1", stdout=subprocess.PIPE, text=True)
        self.environment["DBUS_SESSION_BUS_ADDRESS"] = bus.stdout.readline().strip()
        self.start("openbox", "--sm-disable")

    def run(self, *command, **options):
        done = subprocess.run([str(word) for word in command], env=self.environment, capture_output=True, text=True, **options)
        return done.stdout.strip() if done.returncode == 0 else None

    def screenshot(self, name):
        self.run("import", "-window", "root", self.directory / f"{name}.png")

    def close(self):
        for process in reversed(self.processes):
            process.terminate()
            try:
                process.wait(10)
            except subprocess.TimeoutExpired:
                process.kill()


class KStars:
    def __init__(self, desktop, port):
        self.desktop, self.port = desktop, port

    def prepare(self, exposure_s, elements):
        """The files of a home in which Ekos knows the server, its optical train and the satellite."""
        home, data = self.desktop.home, self.desktop.home / ".local/share/kstars"
        (home / ".config/kstarsrc").write_text(KSTARSRC.format(exposure=exposure_s, satellite=elements[0]))
        (home / ".config/kwalletrc").write_text("[Wallet]\nEnabled=false\n")
        (data / "satellites.dat").write_text("dmise;dmise.tle;\n")
        (data / "dmise.tle").write_text("\n".join(elements) + "\n")
        self.desktop.run("kstars", "--dump", self.desktop.directory / "tmp/sky.png", "--width", 200, "--height", 200, timeout=60)
        self.add_profile(data / "userdb.sqlite")

    def add_profile(self, path):
        with sqlite3.connect(path) as database:
            add = lambda table, **row: database.execute(
                f"INSERT INTO {table} ({', '.join(row)}) VALUES ({', '.join('?' * len(row))})", list(row.values())).lastrowid
            profile = add("profile", name="dmise", host="localhost", port=self.port, autoconnect=1, portselector=0, guidertype=0)
            add("driver", label=MOUNT, role="Mount", profile=profile)
            add("driver", label=CAMERA, role="CCD", profile=profile)
            add("telescope", Vendor="dmise", Model=SENSOR, Aperture=APERTURE_MM, FocalLength=FOCAL_LENGTH_MM, Type="Reflector")
            train = add("opticaltrains", profile=profile, name="Primary", mount=MOUNT, camera=CAMERA, guider=MOUNT,
                        scope=f"dmise {SENSOR} {FOCAL_LENGTH_MM}@F/{FOCAL_LENGTH_MM / APERTURE_MM:.1f}", reducer=1.0,
                        focuser=f"{SENSOR} focuser", filterwheel=f"{SENSOR} filter wheel", dustcap=f"{SENSOR} cover", lightbox="--",
                        rotator="--")
            add("profilesettings", profile=profile, settings=json.dumps({str(module): train for module in range(7)}))
        database.close()

    def call(self, path, method, *arguments):
        """The answer of a method or property of KStars; None if it has none, or not yet."""
        return self.desktop.run("qdbus", "org.kde.kstars", path, method, *arguments, timeout=60)

    def module(self, name, method, *arguments):
        return self.call(f"/KStars/Ekos/{name}", f"org.kde.kstars.Ekos.{name}.{method}", *arguments)

    def start(self):
        with open(self.desktop.directory / "kstars.log", "w") as log:
            self.desktop.start("kstars", stdout=log, stderr=log)
        until("KStars on D-Bus", lambda: self.call("/KStars/Ekos", "org.kde.kstars.Ekos.ekosStatus") is not None, 120)

    def connect(self):
        ekos = lambda name, *arguments: self.call("/KStars/Ekos", f"org.kde.kstars.Ekos.{name}", *arguments)
        ekos("setProfile", "dmise")
        ekos("start")
        until("Ekos starts", lambda: ekos("ekosStatus") == EKOS_DONE, 60)
        until("devices are connected", lambda: ekos("indiStatus") == INDI_DONE, 60)
        until("KStars takes the place of its mount", lambda: "Mount Location" in self.sky("location"), 20)
        until("Ekos has its mount and camera",
              lambda: self.module("Align", "camera") == CAMERA and self.module("Capture", "camera") == CAMERA, 60)

    def numbers(self, module, name):
        """A list of numbers that a method returns, with all digits (qdbus writes six)."""
        answer = self.desktop.run("gdbus", "call", "--session", "--dest", "org.kde.kstars", "--object-path", f"/KStars/Ekos/{module}",
                                  "--method", f"org.kde.kstars.Ekos.{module}.{name}", timeout=60)
        return ast.literal_eval(answer)[0]

    def number(self, name):
        """What KStars has of a property of the mount."""
        return float(self.call("/KStars/INDI", "org.kde.kstars.INDI.getNumber", MOUNT, "EQUATORIAL_EOD_COORD", name))

    def indi_state(self, device, name):
        return self.call("/KStars/INDI", "org.kde.kstars.INDI.getPropertyState", device, name)

    def sky(self, name, *arguments):
        return self.call("/KStars", f"org.kde.kstars.{name}", *arguments)

    def place_of(self, name):
        """Right ascension and declination of an object of KStars' own catalogues, J2000 [deg]."""
        described = self.sky("getObjectDataXML", name)
        return tuple(float(re.search(f"<{key}>(.*)</{key}>", described).group(1)) for key in ("RA_J2000_Degrees", "Dec_J2000_Degrees"))

    def arrive(self):
        """Waits for the beginning and the end of a slew."""
        for state in ("Busy", "Ok"):
            until(f"the mount is {state}", lambda: self.indi_state(MOUNT, "EQUATORIAL_EOD_COORD") == state, 120, 0.02)

    def go_to(self, name):
        self.module("Mount", "gotoTarget", name)
        self.arrive()

    def solve(self, action):
        """Exposes and solves, and with SOLVE_AND_SLEW corrects until it is there. The place of the last frame, J2000 [deg]."""
        self.module("Align", "setSolverAction", action)
        if self.module("Align", "captureAndSolve") != "true":
            raise RuntimeError("Ekos does not solve: " + self.module("Align", "logText"))
        ends = (ALIGN_COMPLETE, ALIGN_FAILED, ALIGN_ABORTED)
        until("a solution", lambda: self.module("Align", "status") in ends, 300)
        if self.module("Align", "status") != ALIGN_COMPLETE:
            raise RuntimeError("not solved:\n" + self.module("Align", "logText"))
        return tuple(self.numbers("Align", "getSolutionResult")[1:])

    def sync(self, ra_h, dec_deg):
        """Tells the mount that it points to a place of date."""
        indi = lambda name, *arguments: self.call("/KStars/INDI", f"org.kde.kstars.INDI.{name}", MOUNT, *arguments)
        indi("setSwitch", "ON_COORD_SET", "SYNC", "On")
        indi("sendProperty", "ON_COORD_SET")
        until("the mount syncs", lambda: indi("getSwitch", "ON_COORD_SET", "SYNC") == "On", 10)
        indi("setNumber", "EQUATORIAL_EOD_COORD", "RA", ra_h)
        indi("setNumber", "EQUATORIAL_EOD_COORD", "DEC", dec_deg)
        indi("sendProperty", "EQUATORIAL_EOD_COORD")

    def capture(self, exposure_s, length_s, midway):
        """Exposes for so long, one image after the other."""
        sequence = self.desktop.directory / "pass.esq"
        sequence.write_text(SEQUENCE.format(exposure=exposure_s, count=int(length_s / exposure_s), directory=self.desktop.directory / "images"))
        self.module("Capture", "loadSequenceQueue", sequence)
        begin = time.monotonic()
        self.module("Capture", "start")
        time.sleep(length_s / 2)
        midway()
        time.sleep(begin + length_s + exposure_s - time.monotonic())
        self.module("Capture", "abort")

    def show(self, window, x, y, width, height):
        for found in (self.desktop.run("xdotool", "search", "--onlyvisible", "--name", window) or "").split():
            self.desktop.run("xdotool", "windowactivate", "--sync", found, "windowsize", found, width, height, "windowmove", found, x, y)

    def arrange(self):
        """The sky map on the left half, Ekos above the properties of the devices on the right."""
        width, height = SCREEN[0] // 2, SCREEN[1]
        self.call("/kstars/MainWindow_1/actions/ekos", "org.qtproject.Qt.QAction.trigger")
        until("the window of Ekos", lambda: self.desktop.run("xdotool", "search", "--onlyvisible", "--name", "^Ekos"), 20)
        self.show("INDI Control Panel", width, height * 2 // 3, width, height // 3)
        self.show("^Ekos", width, 0, width, height * 2 // 3)
        self.show("^KStars$", 0, 0, width, height)

    def show_module(self, number):
        """Chooses a tab of Ekos' window: Setup 0, Scheduler, Analyze, Capture, Focus, Mount, Align 6."""
        self.desktop.run("xdotool", "mousemove", SCREEN[0] // 2 + 38 + 77 * number, 31, "click", 1)

    def look_at(self, name):
        self.sky("setApproxFOV", 20)
        self.sky("lookTowards", name)

    def follow(self, name):
        """Chooses *Track satellite* from the menu of the satellite in the sky map, and waits until the telescope is there."""
        wide, high = (int(text) for text in self.sky("getSkyMapDimensions").split("x"))
        window = self.desktop.run("xdotool", "search", "--onlyvisible", "--name", "^KStars$").split()[0]
        self.desktop.run("xdotool", "windowactivate", "--sync", window)
        size = dict(line.split("=") for line in self.desktop.run("xdotool", "getwindowgeometry", "--shell", window).splitlines())
        x, y = int(size["X"]) + int(size["WIDTH"]) - wide // 2, int(size["Y"]) + int(size["HEIGHT"]) - high // 2
        self.desktop.run("xdotool", "mousemove", x, y)
        for attempt in range(3):  # the sky map does not keep to a satellite, which may have left the pointer
            windows = self.windows()
            self.look_at(name)
            self.desktop.run("xdotool", "click", 3)
            until("the menu", lambda: self.windows() - windows, 10)
            # The mount is the last of the menu, and Track satellite the last but two of the mount's.
            self.desktop.run("xdotool", "key", "--delay", 300, "Up", "Right", "Up", "Up", "Up")
            self.desktop.screenshot("menu")
            self.desktop.run("xdotool", "key", "Return")
            try:
                until("KStars and its mount follow", lambda: self.indi_state(MOUNT, "SAT_TRACKING_STAT") == "Busy", 3, 0.02)
                break
            except Late:
                self.desktop.run("xdotool", "key", "--delay", 200, "Escape", "Escape")
                if attempt == 2:
                    raise
        self.arrive()

    def windows(self):
        return set((self.desktop.run("xdotool", "search", "--onlyvisible", "--class", "kstars") or "").split())


def elements_of(name):
    """The three lines of an object of the demonstration's catalogue."""
    lines = (ROOT / "launch/catalogues/demo.tle").read_text().splitlines()
    at = lines.index(name)
    return lines[at:at + 3]


class Night:
    """The server, its directory and what is read from it."""

    def __init__(self, binary, stars, directory):
        self.directory = directory / "night"
        scenario = directory / "scenario.yaml"
        scenario.write_text(SCENARIO.format(start=START, stars=stars))
        self.process = subprocess.Popen([binary, "observatory", scenario, "--out", self.directory, "--listen", "127.0.0.1:0", "--no-discovery",
                                         "--indi", "127.0.0.1:0"], stdout=subprocess.PIPE, text=True)
        told = self.process.stdout.readline()
        found = re.search(r"INDI at 127\.0\.0\.1:(\d+)", told)
        if not found:
            raise SystemExit(f"{binary} serves no INDI")
        self.port, self.begin = int(found.group(1)), time.monotonic()

    def wait_until(self, after_s):
        """Waits until so many seconds after the beginning of the night."""
        left_s = self.begin + after_s - time.monotonic()
        if left_s < 0:
            raise Late(f"{-left_s:.0f} s too late for the pass of {SATELLITE}")
        time.sleep(left_s)

    def frames(self):
        return sorted((self.directory / SENSOR).glob("frame-*.fits"))

    def centre(self, frame):
        """The middle of a frame by its WCS, ICRS [deg]."""
        with fits.open(frame) as file:
            header = file[0].header
        middle = ((header["NAXIS1"] - 1) / 2, (header["NAXIS2"] - 1) / 2)
        return tuple(float(x) for x in WCS(header).all_pix2world(*middle, 0))

    def end(self):
        self.process.send_signal(signal.SIGINT)
        self.process.communicate(timeout=120)

    def lines(self, name):
        return [json.loads(line) for line in (self.directory / name).read_text().splitlines()]


def centroid(image, x, y, half=8):
    """The centroid of what stands out of the sky around a pixel; None if nothing does."""
    left, low = round(x) - half, round(y) - half
    piece = image[low:low + 2 * half + 1, left:left + 2 * half + 1].astype(float)
    sky = numpy.median(image)
    piece -= sky
    piece[piece < 5 * 1.4826 * numpy.median(numpy.abs(image - sky))] = 0.0
    if piece.shape != (2 * half + 1, 2 * half + 1) or not piece.sum():
        return None
    rows, columns = numpy.indices(piece.shape)
    return left + (columns * piece).sum() / piece.sum(), low + (rows * piece).sum() / piece.sum()


def solve_fields(kstars, night, desktop):
    for name, binning in FIELDS.items():
        wanted = kstars.place_of(name)
        kstars.go_to(name)
        kstars.module("Align", "setBinningIndex", binning - 1)
        begin = time.monotonic()
        found = kstars.solve(SOLVE_ONLY)
        took_s = time.monotonic() - begin
        frame = night.frames()[-1]
        solver_s = re.findall(r"Solver completed after ([\d.]+) seconds", kstars.module("Align", "logText"))[0]
        print(f"{name}, {binning} x {binning}: Ekos solves {frame.name} in {solver_s} s ({took_s:.1f} s with its exposure), "
              f"{apart_arcsec(found, wanted):.2f} arcsec from where it sent the telescope, "
              f"{apart_arcsec(found, night.centre(frame)):.2f} arcsec from the middle by the frame's WCS")
    kstars.module("Align", "setBinningIndex", 0)
    kstars.show_module(6)
    desktop.screenshot("solved")


def correct_pointing(kstars, night, desktop):
    """The mount is told that it stands elsewhere; Ekos finds out, and brings it to the cluster."""
    wanted = kstars.place_of(CLUSTER)
    ra_h, dec_deg = kstars.number("RA"), kstars.number("DEC")
    kstars.sync(ra_h + 0.5 / 15 / math.cos(math.radians(dec_deg)), dec_deg)
    kstars.go_to(CLUSTER)
    before = len(night.frames())
    found = kstars.solve(SOLVE_AND_SLEW)
    desktop.screenshot("corrected")
    kstars.show_module(0)
    wrong = apart_arcsec(night.centre(night.frames()[before]), wanted)
    print(f"{CLUSTER} with a mount that is {wrong:.0f} arcsec wrong: Ekos solves, syncs, slews and solves again: "
          f"{apart_arcsec(found, wanted):.2f} arcsec from it, {apart_arcsec(night.centre(night.frames()[-1]), wanted):.2f} by the frame's WCS")


def follow_satellite(kstars, night, desktop, exposure_s):
    def midway():
        kstars.look_at(SATELLITE)
        time.sleep(1.0)  # the sky map is drawn anew
        desktop.screenshot("followed")

    night.wait_until(PASS_AFTER_S)
    kstars.follow(SATELLITE)
    before = len(night.frames())
    kstars.capture(exposure_s, PASS_S, midway)
    return [int(frame.stem.split("-")[1]) for frame in night.frames()[before:]]


def tell_pass(night, numbers):
    """Where the satellite is in each frame: from the middle by the truth, and its centroid from the truth [px]."""
    truths = {line["frame"]: line for line in night.lines("truth.jsonl") if line["name"] == SATELLITE}
    seen = [truths[number] for number in numbers if truths.get(number, {}).get("in_frame")]
    print(f"{SATELLITE}: in {len(seen)} of {len(numbers)} frames")
    if not seen:
        return
    off_centre, off_truth = [], []
    for truth in seen:
        image = fits.getdata(night.directory / SENSOR / f"frame-{truth['frame']:06d}.fits")
        middle = ((image.shape[1] - 1) / 2, (image.shape[0] - 1) / 2)
        off_centre.append(math.dist(truth["middle_px"], middle))
        light = centroid(image, *truth["middle_px"])
        off_truth.append(math.dist(light, truth["rendered_px"]) if light else math.nan)
        print(f"   {truth['middle_utc']}: {truth['true_elevation_deg']:.1f} deg high, V = {truth['true_magnitude']:.1f}, {off_centre[-1]:.2f} px "
              f"from the middle, {math.dist(truth['start_px'], middle):.2f} px at the beginning and {math.dist(truth['end_px'], middle):.2f} px "
              f"at the end, centroid {off_truth[-1]:.2f} px from the truth")
    print(f"   followed for {(seen[-1]['end_ns'] - seen[0]['start_ns']) / 1e9:.1f} s: at most {max(off_centre):.2f} px from the middle in mid "
          f"exposure; centroids from the truth {numpy.nanmedian(off_truth):.2f} px (median), {numpy.nanmax(off_truth):.2f} px at most")


def same_images(night, images):
    """How many of the files that Ekos saved have the bytes of a frame of the night."""
    frames = {path.read_bytes() for path in night.frames()}
    saved = sorted(images.rglob("*.fits"))
    print(f"{len(saved)} images that Ekos saved, {sum(path.read_bytes() in frames for path in saved)} with the bytes of a frame")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--binary", default=str(ROOT / "build/release/bin/dmise"))
    parser.add_argument("--stars", default="tycho2", help="catalogue of the scenario: tycho2, or the path of its index")
    parser.add_argument("--exposure", type=float, default=2.0, help="of a frame that is solved [s]")
    parser.add_argument("--pass-exposure", type=float, default=1.0, help="of a frame of the satellite [s]")
    parser.add_argument("--out", type=pathlib.Path)
    options = parser.parse_args()
    warnings.simplefilter("ignore", FITSFixedWarning)
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # so that what was started is ended
    directory = (options.out or pathlib.Path(tempfile.mkdtemp(prefix="ekos-night-"))).resolve()
    directory.mkdir(parents=True, exist_ok=True)
    desktop = Desktop(directory)
    night = Night(options.binary, options.stars, directory)
    try:
        desktop.open()
        kstars = KStars(desktop, night.port)
        kstars.prepare(options.exposure, elements_of(SATELLITE))
        kstars.start()
        kstars.connect()
        kstars.arrange()
        solve_fields(kstars, night, desktop)
        correct_pointing(kstars, night, desktop)
        numbers = follow_satellite(kstars, night, desktop, options.pass_exposure)
    finally:
        night.end()
        desktop.close()
    tell_pass(night, numbers)
    same_images(night, directory / "images")
    print(f"screenshots and the night are in {directory}")


if __name__ == "__main__":
    main()
