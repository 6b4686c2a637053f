"""An observatory's software that speaks INDI points and exposes a scenario's cameras; the same night is made again without it.

    observatory_indi.py DMISE [--elements N]

indipyclient reads all properties, slews, exposes, aborts, guides and parks; images are the FITS files, which show the stars at the
place of date that was told (by astropy); wrong values are answered by Alert. N: of random elements, 2000 unless said. If Debian's
indi-bin is installed, its clients, of INDI's own library, read the same.
"""

import asyncio
import io
import json
import random
import shutil
import socket
import subprocess
import sys
import threading

try:
    import astropy.io.fits
    import astropy.utils.iers
    import numpy
    from astropy.coordinates import TETE, SkyCoord
    from astropy.time import Time
    from astropy.wcs import WCS
    from indipyclient import IPyClient
except ImportError as missing:
    print(f"skipped: {missing.name} is not installed (./dmise setup --tests)")
    sys.exit(77)

from served_observatory import ARCSEC, ROOT, Served, argument, check, journal, main, path_of, same_again, wait_until  # noqa: E402

astropy.utils.iers.conf.auto_download = False
TELESCOPE, CAMERA = "telescope telescope", "telescope camera"
FOCUSER, WHEEL, COVER, WEATHER = (f"telescope {kind}" for kind in ("focuser", "filter wheel", "cover", "weather"))

# What Ekos, the observatory software of KStars, looks for.
OF_A_TELESCOPE = {
    "CONNECTION", "DRIVER_INFO", "EQUATORIAL_EOD_COORD", "ON_COORD_SET", "TELESCOPE_ABORT_MOTION", "TELESCOPE_PARK",
    "TELESCOPE_TRACK_STATE", "TELESCOPE_TRACK_MODE", "TELESCOPE_TRACK_RATE", "TELESCOPE_TIMED_GUIDE_NS",
    "TELESCOPE_TIMED_GUIDE_WE", "TELESCOPE_MOTION_NS", "TELESCOPE_MOTION_WE", "TELESCOPE_SLEW_RATE", "TELESCOPE_PIER_SIDE",
    "GEOGRAPHIC_COORD", "TIME_UTC", "TELESCOPE_INFO", "GUIDE_RATE", "SAT_TLE_TEXT", "SAT_PASS_WINDOW", "SAT_TRACKING_STAT"}
OF_A_CAMERA = {
    "CONNECTION", "DRIVER_INFO", "CCD_EXPOSURE", "CCD_ABORT_EXPOSURE", "CCD_FRAME", "CCD_FRAME_RESET", "CCD_BINNING", "CCD_INFO",
    "CCD_TEMPERATURE", "CCD_COOLER", "CCD_FRAME_TYPE", "CCD_COMPRESSION", "CCD1", "ACTIVE_DEVICES", "UPLOAD_MODE"}
OF_A_FOCUSER = {"CONNECTION", "DRIVER_INFO", "FOCUS_MOTION", "REL_FOCUS_POSITION", "ABS_FOCUS_POSITION", "FOCUS_MAX",
                "FOCUS_ABORT_MOTION", "FOCUS_TEMPERATURE"}
OF_A_WHEEL = {"CONNECTION", "DRIVER_INFO", "FILTER_SLOT", "FILTER_NAME"}
OF_A_COVER = {"CONNECTION", "DRIVER_INFO", "CAP_PARK"}
OF_A_WEATHER = {"CONNECTION", "DRIVER_INFO", "WEATHER_PARAMETERS", "WEATHER_UPDATE", "WEATHER_REFRESH"}
# Devices, their properties, and the bits by which Ekos knows them.
DEVICES = ((TELESCOPE, OF_A_TELESCOPE, 1 | 4), (CAMERA, OF_A_CAMERA, 2), (FOCUSER, OF_A_FOCUSER, 8), (WHEEL, OF_A_WHEEL, 16),
           (COVER, OF_A_COVER, 512), (WEATHER, OF_A_WEATHER, 128))
# Wrong values: a property, its items, a part of the message.
WRONG = [
    (TELESCOPE, "EQUATORIAL_EOD_COORD", {"RA": 25, "DEC": 0}, "RA must be 0 to 24"),
    (TELESCOPE, "EQUATORIAL_EOD_COORD", {"RA": "nan", "DEC": 0}, "RA must be a number"),
    (TELESCOPE, "EQUATORIAL_EOD_COORD", {"RA": 0, "DEC": -80}, "below the least elevation"),
    (TELESCOPE, "TELESCOPE_TIMED_GUIDE_NS", {"TIMED_GUIDE_N": 10, "TIMED_GUIDE_S": 10}, "one direction at a time"),
    (TELESCOPE, "TELESCOPE_TIMED_GUIDE_NS", {"TIMED_GUIDE_N": 99999, "TIMED_GUIDE_S": 0}, "TIMED_GUIDE_N must be 0 to 60000"),
    (CAMERA, "CCD_EXPOSURE", {"CCD_EXPOSURE_VALUE": 0}, "must be 0.001 to 3600"),
    (CAMERA, "CCD_BINNING", {"HOR_BIN": 1, "VER_BIN": 2}, "both binnings must be the same"),
    (CAMERA, "CCD_FRAME", {"X": 1000, "Y": 0, "WIDTH": 100, "HEIGHT": 100}, "reaches beyond 1024 x 1024"),
    (CAMERA, "CCD_TEMPERATURE", {"CCD_TEMPERATURE_VALUE": -300}, "must be -100 to 50"),
    (CAMERA, "CCD_COMPRESSION", {"INDI_ENABLED": "On", "INDI_DISABLED": "Off"}, "images are not compressed"),
    (FOCUSER, "ABS_FOCUS_POSITION", {"FOCUS_ABSOLUTE_POSITION": 1e6}, "FOCUS_ABSOLUTE_POSITION must be 0 to"),
    (WHEEL, "FILTER_SLOT", {"FILTER_SLOT_VALUE": 5}, "FILTER_SLOT_VALUE must be 1 to 4"),
    (TELESCOPE, "SAT_TLE_TEXT", {"TLE": "1 25544U"}, "the element set")]


class Client(IPyClient):
    """indipyclient in a thread of its own."""

    def __init__(self, port, blobs="Also"):
        super().__init__("127.0.0.1", port)
        self.enableBLOBdefault = blobs
        self.heard, self.images = [], []  # what came in, in order
        self.thread = threading.Thread(target=self.live)

    def live(self):
        self.loop = asyncio.new_event_loop()
        self.loop.run_until_complete(self.asyncrun())

    def __enter__(self):
        self.thread.start()
        wait_until(lambda: self.connected, "the client's connection")
        return self

    def __exit__(self, *_):
        self.loop.call_soon_threadsafe(self.shutdown)
        self.thread.join(60)

    async def rxevent(self, event):
        if event.eventtype == "SetBLOB":
            self.images.append((event.devicename, event["CCD1"], event.sizeformat["CCD1"]))
        self.heard.append((event.eventtype, event.devicename, event.vectorname, getattr(event, "state", None),
                           getattr(event, "message", "")))

    def set(self, device, vector, items):
        """Sets a property; returns its state and message in the first answer."""
        before = len(self.heard)
        asyncio.run_coroutine_threadsafe(
            self.send_newVector(device, vector, members={k: v if isinstance(v, str) else repr(v) for k, v in items.items()}),
            self.loop).result(60)
        return wait_until(lambda: [h[3:] for h in list(self.heard)[before:] if h[:3] == ("Set", device, vector)],
                          f"the answer to {vector}")[0]

    def switch(self, device, vector, item):
        return self.set(device, vector, {item: "On"})

    def has(self, device, vector):
        return device in self and vector in self[device] and self[device][vector].enable

    def state(self, device, vector):
        return self[device][vector].state

    def number(self, device, vector, item):
        return self[device][vector].member(item).getfloatvalue()

    def until(self, device, vector, state):
        wait_until(lambda: self.state(device, vector) == state, f"{vector} {state}")

    def expose(self, length_s):
        """Returns the bytes of the image."""
        before = len(self.images)
        answered = self.set(CAMERA, "CCD_EXPOSURE", {"CCD_EXPOSURE_VALUE": length_s})
        check(answered[0] == "Busy", f"an exposure of {length_s} s begins {answered[1]}")
        wait_until(lambda: len(self.images) > before, "an image")
        self.until(CAMERA, "CCD_EXPOSURE", "Ok")
        _, image, (size, ending) = self.images[-1]
        check((size, ending) == (len(image), ".fits"), "the image is a FITS file of its size")
        return image


def connects(client):
    wait_until(lambda: len(client) == 12 and all(client.has(d, "CONNECTION") for d in client), "six devices of each sensor")
    check(not client.has(TELESCOPE, "EQUATORIAL_EOD_COORD"), "before they are connected devices tell who they are")
    for device, expected, interface in DEVICES:
        client.switch(device, "CONNECTION", "CONNECT")
        wait_until(lambda: all(client.has(device, v) for v in expected), f"the properties of {device}")
        check(int(client[device]["DRIVER_INFO"]["DRIVER_INTERFACE"]) == interface, f"{device} is what Ekos wants")


def told_place(client):
    return client.number(TELESCOPE, "EQUATORIAL_EOD_COORD", "RA"), client.number(TELESCOPE, "EQUATORIAL_EOD_COORD", "DEC")


def slew(client, ra_h, dec_deg):
    before = len(client.heard)
    state, message = client.set(TELESCOPE, "EQUATORIAL_EOD_COORD", {"RA": ra_h, "DEC": dec_deg})
    check(state != "Alert", f"it slews {message}")  # what is told first may be where it was
    wait_until(lambda: any(h[1:4] == (TELESCOPE, "EQUATORIAL_EOD_COORD", "Busy") for h in list(client.heard)[before:]), "the slew")
    wait_until(lambda: client.state(TELESCOPE, "EQUATORIAL_EOD_COORD") != "Busy", "the end of the slew")


def is_centred(image, ra_h, dec_deg):
    """Offset of the image's centre from a place of date [arcsec], by astropy."""
    header = astropy.io.fits.open(io.BytesIO(image))[0].header
    middle = Time(header["DATE-AVG"], scale="utc")
    told = SkyCoord(ra_h * 15, dec_deg, unit="deg", frame=TETE(obstime=middle)).icrs
    offset = told.separation(WCS(header).pixel_to_world(511.5, 511.5)).arcsec
    check(offset < 1.0, f"by astropy its centre is {offset:.2f} arcsec from the place of date that was told")


def points_and_exposes(client, other, out):
    utc = client[TELESCOPE]["TIME_UTC"]["UTC"]
    site_deg = client.number(TELESCOPE, "GEOGRAPHIC_COORD", "LONG")
    sidereal_h = Time(utc, scale="utc").sidereal_time("apparent", longitude=f"{site_deg}d").hour
    ra_h, dec_deg = (sidereal_h - 1.0) % 24, 30.0
    slew(client, ra_h, dec_deg)
    told_h, told_deg = told_place(client)
    check(client.state(TELESCOPE, "TELESCOPE_TRACK_STATE") == "Ok" and abs(told_h - ra_h) * 15 < ARCSEC and
          abs(told_deg - dec_deg) < ARCSEC, "it is where it was sent, and tracks")
    image = client.expose(1.0)
    check(image == path_of(out, "telescope", 1).read_bytes(), "the image is the frame's file, byte for byte")
    is_centred(image, ra_h, dec_deg)
    other.until(CAMERA, "CCD_EXPOSURE", "Ok")
    check(not other.images and any(h[2:4] == ("EQUATORIAL_EOD_COORD", "Busy") for h in other.heard),
          "another client hears it all, and gets no images that it did not enable")

    client.set(CAMERA, "CCD_BINNING", {"HOR_BIN": 2, "VER_BIN": 2})
    client.set(CAMERA, "CCD_FRAME", {"X": 200, "Y": 100, "WIDTH": 400, "HEIGHT": 600})
    part = astropy.io.fits.open(io.BytesIO(client.expose(0.5)))[0]
    whole = astropy.io.fits.getdata(path_of(out, "telescope", 2)).astype(int)
    binned = whole.reshape(512, 2, 512, 2).sum(axis=(1, 3)).clip(0, 65535)
    check(part.data.dtype == numpy.uint16 and (part.data == binned[50:350, 100:300]).all() and part.header["XBINNING"] == 2 and
          part.header["EXPTIME"] == 0.5, "binning adds the counts of a window")
    client.switch(CAMERA, "CCD_FRAME_RESET", "RESET")
    wait_until(lambda: client.number(CAMERA, "CCD_FRAME", "WIDTH") == 1024, "the whole frame")
    return ra_h, dec_deg


def refuses(client):
    for device, vector, items, reason in WRONG:
        state, message = client.set(device, vector, items)
        check(state == "Alert" and reason in message, message)
    client.set(CAMERA, "CCD_EXPOSURE", {"CCD_EXPOSURE_VALUE": 30.0})
    state, message = client.set(TELESCOPE, "EQUATORIAL_EOD_COORD", {"RA": 1.0, "DEC": 50.0})
    check(state == "Alert" and "an exposure is open" in message, "it does not slew while a shutter is open")
    before = len(client.images)
    client.switch(CAMERA, "CCD_ABORT_EXPOSURE", "ABORT")
    client.until(CAMERA, "CCD_EXPOSURE", "Idle")
    check(len(client.images) == before, "an exposure can be aborted, and has no image")


def moves_on(client, out, place):
    ra_h, dec_deg = place
    client.switch(TELESCOPE, "ON_COORD_SET", "SYNC")
    client.set(TELESCOPE, "EQUATORIAL_EOD_COORD", {"RA": ra_h, "DEC": dec_deg + 0.1})
    wait_until(lambda: abs(told_place(client)[1] - dec_deg - 0.1) < ARCSEC, "the place that a sync told")
    check(client.set(TELESCOPE, "TELESCOPE_TIMED_GUIDE_NS", {"TIMED_GUIDE_N": 500, "TIMED_GUIDE_S": 0})[0] == "Busy", "it guides")
    client.until(TELESCOPE, "TELESCOPE_TIMED_GUIDE_NS", "Ok")
    moved = (told_place(client)[1] - dec_deg - 0.1) / ARCSEC
    check(abs(moved - 0.5 * 0.5 * 15.04) < 0.1, f"half a second of half the sidereal rate is {moved:.2f} arcsec")
    client.set(TELESCOPE, "TELESCOPE_TRACK_RATE", {"TRACK_RATE_RA": 15.041069 - 150.0, "TRACK_RATE_DE": 20.0})
    check(client.expose(0.5) == path_of(out, "telescope", journal(out)[-1]["frame"]).read_bytes() and
          client[TELESCOPE]["TELESCOPE_TRACK_MODE"]["TRACK_CUSTOM"] == "On", "it follows a satellite")
    rates = [journal(out)[-1][key] * 3600 for key in ("ra_rate_deg_per_s", "dec_rate_deg_per_s")]
    check(numpy.allclose(rates, [150.0, 20.0], atol=1e-3), "at the rates that were told")
    client.switch(TELESCOPE, "TELESCOPE_TRACK_MODE", "TRACK_SIDEREAL")
    client.switch(TELESCOPE, "ON_COORD_SET", "SLEW")
    slew(client, ra_h, dec_deg + 5.0)
    client.until(TELESCOPE, "EQUATORIAL_EOD_COORD", "Idle")
    client.expose(0.5)
    check("ra_deg" not in journal(out)[-1], "after SLEW it stands still")
    check(client.switch(TELESCOPE, "TELESCOPE_MOTION_NS", "MOTION_SOUTH")[0] == "Busy", "it is moved by hand")
    client.switch(TELESCOPE, "TELESCOPE_ABORT_MOTION", "ABORT")
    wait_until(lambda: client.state(TELESCOPE, "TELESCOPE_MOTION_NS") != "Busy", "the end of the motion")
    client.switch(TELESCOPE, "TELESCOPE_PARK", "PARK")
    client.until(TELESCOPE, "TELESCOPE_PARK", "Ok")
    state, message = client.switch(TELESCOPE, "TELESCOPE_TRACK_STATE", "TRACK_ON")
    check(state == "Alert" and "parked" in message, "parked, it does not track")


def changes_the_light(client, out):
    """Filter, focus and cover go into the frame's journal and file."""
    middle = client.number(FOCUSER, "ABS_FOCUS_POSITION", "FOCUS_ABSOLUTE_POSITION")
    check(client[WHEEL]["FILTER_NAME"]["FILTER_SLOT_NAME_4"] == "clear", "filters have names")
    check(client.set(WHEEL, "FILTER_SLOT", {"FILTER_SLOT_VALUE": 4})[0] == "Busy", "the wheel turns")
    client.switch(FOCUSER, "FOCUS_MOTION", "FOCUS_INWARD")
    client.set(FOCUSER, "REL_FOCUS_POSITION", {"FOCUS_RELATIVE_POSITION": 60})
    client.until(WHEEL, "FILTER_SLOT", "Ok")
    wait_until(lambda: client.number(FOCUSER, "ABS_FOCUS_POSITION", "FOCUS_ABSOLUTE_POSITION") == middle - 60, "the focus")
    client.until(FOCUSER, "ABS_FOCUS_POSITION", "Ok")
    header = astropy.io.fits.open(io.BytesIO(client.expose(0.5)))[0].header
    check(header["FILTER"] == "clear" and abs(header["DEFOCUS"] + 60) < 1e-6 and journal(out)[-1]["focus_um"] == -60,
          f"the image has the filter {header['FILTER']}, and is {header['DEFOCUS']:.3f} um out of focus")
    client.switch(CAMERA, "CCD_FRAME_TYPE", "FRAME_DARK")
    check(astropy.io.fits.open(io.BytesIO(client.expose(0.5)))[0].data.max() < 400, "a dark frame is dark")
    client.switch(CAMERA, "CCD_FRAME_TYPE", "FRAME_LIGHT")
    check(client.switch(COVER, "CAP_PARK", "PARK")[0] == "Busy", "the cover closes")
    client.until(COVER, "CAP_PARK", "Ok")
    check(astropy.io.fits.open(io.BytesIO(client.expose(0.5)))[0].data.max() < 400, "behind the cover it is dark")
    client.switch(COVER, "CAP_PARK", "UNPARK")
    client.until(COVER, "CAP_PARK", "Ok")
    check(5 < client.number(WEATHER, "WEATHER_PARAMETERS", "WEATHER_TEMPERATURE") < 25, "the weather is the scenario's")


def follows_a_satellite(client, out, place):
    """By its elements, in the property that KStars has for them. Truth, which knows of no telescope that follows, has it in the image's middle, still."""
    lines = (ROOT / "launch/catalogues/demo.tle").read_text().splitlines()
    at = lines.index("MOLNIYA 1-88")
    client.set(TELESCOPE, "SAT_TLE_TEXT", {"TLE": "\n".join(lines[at:at + 3])})
    check(client.switch(TELESCOPE, "SAT_TRACKING_STAT", "SAT_TRACK")[0] == "Busy", "it goes to a satellite")
    client.until(TELESCOPE, "EQUATORIAL_EOD_COORD", "Ok")
    state, message = client.set(TELESCOPE, "TELESCOPE_TRACK_RATE", {"TRACK_RATE_RA": 15.0, "TRACK_RATE_DE": 20.0})
    check(state == "Alert" and "follows a satellite" in message, "and takes no other rates")
    client.expose(2.0)
    frame = journal(out)[-1]["frame"]
    truths = [json.loads(line) for line in (out / "telescope/truth.jsonl").read_text().splitlines()]
    truth, = (t for t in truths if t["frame"] == frame and t["catalogue_number"] == 23420)
    start, middle, end = (numpy.array(truth[f"{when}_px"]) for when in ("start", "middle", "end"))
    offset, length = numpy.hypot(*(middle - 511.5)), numpy.hypot(*(end - start))
    rate = numpy.hypot(journal(out)[-1]["ra_rate_deg_per_s"], journal(out)[-1]["dec_rate_deg_per_s"]) * 3600
    check(offset < 0.5 and length < 0.1 and rate > 10, f"in 2 s at {rate:.0f} arcsec/s it is {offset:.3f} px from the image's middle, and moves by {length:.3f} px")
    client.switch(TELESCOPE, "SAT_TRACKING_STAT", "SAT_HALT")
    check(client.state(TELESCOPE, "TELESCOPE_TRACK_STATE") == "Ok", "afterwards it stays with the stars")
    slew(client, *place)


def is_read_by_indi_bin(client, port):
    """INDI's own clients, if they are installed."""
    if not shutil.which("indi_getprop"):
        return print("   indi_getprop is not installed")
    got = subprocess.run(["indi_getprop", "-p", str(port), "-t", "30", f"{TELESCOPE}.EQUATORIAL_EOD_COORD.DEC",
                          f"{CAMERA}.CCD_INFO.CCD_MAX_X"], capture_output=True, text=True, timeout=60).stdout
    values = dict(line.split("=") for line in got.split("\n") if line)
    check(float(values[f"{CAMERA}.CCD_INFO.CCD_MAX_X"]) == 1024 and
          abs(float(values[f"{TELESCOPE}.EQUATORIAL_EOD_COORD.DEC"]) - told_place(client)[1]) < ARCSEC, "indi_getprop reads the same")
    subprocess.run(["indi_setprop", "-p", str(port), f"{TELESCOPE}.TELESCOPE_PARK.UNPARK=On"], check=True, timeout=60)
    wait_until(lambda: client[TELESCOPE]["TELESCOPE_PARK"]["UNPARK"] == "On", "indi_setprop unparks")


def random_elements(port, count, seed=2):
    """Elements that are right, nearly right or none. Nothing ends but connections."""
    draw = random.Random(seed)
    texts = ["1", "0", "-1", "On", "Off", "", "nan", "1e308", "5:30:00", "x" * 300, "&#1;", "&amp;", "\u00e9", "]]>", "<a>"]
    names = sorted(set().union(*(properties for _, properties, _ in DEVICES))) + ["", "x", "'"]
    items = ["FOCUS_ABSOLUTE_POSITION", "FILTER_SLOT_VALUE", "SAT_TRACK", "TLE", "RA", "DEC", "TRACK", "SYNC", "PARK", "CCD_EXPOSURE_VALUE", "HOR_BIN", "VER_BIN", "X", "WIDTH", "ABORT", "CONNECT"]

    def element():
        """Its bytes, and whether they may end a connection."""
        kind = draw.random()
        if kind < 0.02:
            return draw.randbytes(draw.randrange(1, 300)), True
        if kind < 0.04:
            return draw.choice([b"<!DOCTYPE a [<!ENTITY b 'c'>]>", b"<a><b><c/></b></a>", b"</a>", b"GET / HTTP/1.1\r\n\r\n",
                                b"<" + b"a" * 70000]), True
        if kind < 0.1:
            return f"<enableBLOB device='{CAMERA}'>{draw.choice(['Never', 'Also', 'Only'])}</enableBLOB>".encode(), False
        if kind < 0.15:
            return f"<getProperties version='1.7' device='{draw.choice([TELESCOPE, CAMERA, 'x'])}'/>".encode(), False
        what = draw.choice(["Number", "Switch", "Text", "BLOB", "Light"])
        ones = "".join(f"<one{what} name=\"{draw.choice(items)}\">{draw.choice(texts)}</one{what}>" for _ in range(draw.randrange(4)))
        device, name = draw.choice([device for device, _, _ in DEVICES]), draw.choice(names)
        return f"<new{what}Vector device='{device}' name=\"{name}\">{ones}</new{what}Vector>".encode(), not name or "<a>" in ones

    link, connections = None, 0
    for _ in range(count):
        if not link:
            link, connections = socket.create_connection(("127.0.0.1", port), timeout=30), connections + 1
            link.setblocking(False)
        bytes_, is_last = element()
        try:
            link.sendall(bytes_)
            while not is_last and link.recv(1 << 16):
                pass
        except BlockingIOError:  # nothing to read, now
            if not is_last:
                continue
        except ConnectionError:
            pass
        link = link.close()
    print(f"   {count} random elements over {connections} connections")


def ends_nothing(client, served):
    idle = [socket.create_connection(("127.0.0.1", served.indi_port)) for _ in range(3)]
    for link in idle:  # they ask for all, and never read
        link.sendall(f"<getProperties version='1.7'/><enableBLOB device='{CAMERA}'>Also</enableBLOB>".encode())
    random_elements(served.indi_port, argument("--elements", 2000))
    client.switch(CAMERA, "CONNECTION", "CONNECT")
    wait_until(lambda: client.has(CAMERA, "CCD_ABORT_EXPOSURE"), "the camera after random elements")
    client.switch(CAMERA, "CCD_ABORT_EXPOSURE", "ABORT")
    check(served.process.poll() is None, "random elements and clients that never read end nothing")
    for link in idle:
        link.close()


def test(binary, directory):
    out = directory / "night"
    refused = subprocess.run([binary, "observatory", "launch/scenarios/observatory.yaml", "--out", out, "--listen", "127.0.0.1:0",
                              "--no-discovery", "--indi", "0.0.0.0:0"], cwd=ROOT, capture_output=True, text=True)
    check(refused.returncode == 2 and "INDI knows no passwords" in refused.stderr and not out.exists(), "it is for this machine alone")
    with Served(binary, out, "--slew-rate", "60", "--settle", "0.2", "--no-discovery", "--indi", "127.0.0.1:0") as served:
        with Client(served.indi_port) as client, Client(served.indi_port, blobs="Never") as other:
            connects(client)
            place = points_and_exposes(client, other, out)
            refuses(client)
            changes_the_light(client, out)
            follows_a_satellite(client, out, place)
            moves_on(client, out, place)
            is_read_by_indi_bin(client, served.indi_port)
            ends_nothing(client, served)
    check(served.process.returncode == 0, "Ctrl-C ends the night")
    same_again(binary, out, directory)


if __name__ == "__main__":
    main(test)
