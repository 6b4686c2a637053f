"""An observatory's software, alpyca, points and exposes a scenario's cameras; the same night is made again without it.

    observatory.py DMISE [--requests N] [--figures]

Every member of alpyca's devices answers as ASCOM's interfaces say; images are those of the FITS files, which show
the stars where the telescope was told to point; `dmise observatory --commands` makes the same bytes. N: of random requests to
the server, 2000 unless said.
"""

import collections
import inspect
import random
import re
import socket
import sys
import time

try:
    import alpaca.discovery
    import numpy
    from alpaca import management
    from alpaca.camera import Camera, CameraStates, SensorType
    from alpaca.covercalibrator import CalibratorStatus, CoverCalibrator, CoverStatus
    from alpaca.device import Device
    from alpaca.exceptions import (ActionNotImplementedException, AlpacaRequestException, InvalidOperationException,
                                   InvalidValueException, NotConnectedException, NotImplementedException, ParkedException)
    from alpaca.filterwheel import FilterWheel
    from alpaca.focuser import Focuser
    from alpaca.observingconditions import ObservingConditions
    from alpaca.telescope import (AlignmentModes, DriveRates, EquatorialCoordinateType, GuideDirections, PierSide, Telescope,
                                  TelescopeAxes)
    from astropy.wcs import WCS
except ImportError as missing:
    print(f"skipped: {missing.name} is not installed (./dmise setup --tests)")
    sys.exit(77)

from served_observatory import (ARCSEC, Failure, Served, argument, check, file_of, free_udp_port, journal, main, same_again,  # noqa: E402
                                wait_until)

# What a member answers: a value, a condition of it, or what it raises.
A_NUMBER = lambda value: isinstance(value, (int, float))  # noqa: E731
A_TEXT = lambda value: isinstance(value, str) and value  # noqa: E731
OF_DEVICES = {
    "Action": ActionNotImplementedException, "CommandBlind": NotImplementedException, "CommandBool": NotImplementedException,
    "CommandString": NotImplementedException, "Connect": None, "Disconnect": None, "Connected": True, "Connecting": False,
    "Description": A_TEXT, "DeviceState": lambda items: {"Name", "Value"} == set(items[0]), "DriverInfo": lambda v: v[0],
    "DriverVersion": A_TEXT, "InterfaceVersion": lambda v: v in (2, 3, 4), "Name": A_TEXT, "SupportedActions": []}
OF_A_CAMERA = {
    "BayerOffsetX": NotImplementedException, "BayerOffsetY": NotImplementedException, "BinX": 1, "BinY": 1,
    "CameraState": CameraStates.cameraIdle, "CameraXSize": 1024, "CameraYSize": 1024, "CanAbortExposure": True,
    "CanAsymmetricBin": False, "CanFastReadout": False, "CanGetCoolerPower": True, "CanPulseGuide": False,
    "CanSetCCDTemperature": True, "CanStopExposure": True, "CCDTemperature": -20, "CoolerOn": True,
    "CoolerPower": lambda v: 0 < v <= 100, "ElectronsPerADU": 1.4, "ExposureMax": 3600, "ExposureMin": 0.001,
    "ExposureResolution": lambda v: 0 < v <= 0.001, "FastReadout": NotImplementedException, "FullWellCapacity": 90000,
    "Gain": 0, "GainMax": NotImplementedException, "GainMin": NotImplementedException, "Gains": ["1.4 e-/DN"],
    "HasShutter": True, "HeatSinkTemperature": A_NUMBER, "ImageArray": InvalidOperationException,  # and alpyca takes errors of the raw one for this
    "ImageArrayRaw": InvalidValueException, "ImageArrayInfo": None, "ImageReady": False,
    "IsPulseGuiding": NotImplementedException, "LastExposureDuration": InvalidOperationException,
    "LastExposureStartTime": InvalidOperationException, "MaxADU": 65535, "MaxBinX": 8, "MaxBinY": 8, "NumX": 1024, "NumY": 1024,
    "Offset": 0, "OffsetMax": NotImplementedException, "OffsetMin": NotImplementedException, "Offsets": ["300 DN"],
    "PercentCompleted": 0, "PixelSizeX": 13, "PixelSizeY": 13, "ReadoutMode": 0, "ReadoutModes": ["Normal"],
    "SensorName": "telescope-0.3m", "SensorType": SensorType.Monochrome, "SetCCDTemperature": -20, "StartX": 0, "StartY": 0,
    "SubExposureDuration": NotImplementedException, "AbortExposure": None, "StopExposure": None,
    "PulseGuide": NotImplementedException, "StartExposure": InvalidValueException}
OF_A_TELESCOPE = {
    "AlignmentMode": AlignmentModes.algGermanPolar, "Altitude": lambda v: abs(v - 34.725) < 1e-6,
    "ApertureArea": lambda v: abs(v - numpy.pi / 4 * 0.3**2 * (1 - 0.4**2)) < 1e-9, "ApertureDiameter": 0.3, "AtHome": True,
    "AtPark": False, "Azimuth": lambda v: abs(v) < 1e-9, "CanFindHome": True, "CanPark": True, "CanPulseGuide": True,
    "CanSetDeclinationRate": True, "CanSetGuideRates": True, "CanSetPark": True, "CanSetPierSide": False,
    "CanSetRightAscensionRate": True, "CanSetTracking": True, "CanSlew": True, "CanSlewAsync": True, "CanSlewAltAz": True,
    "CanSlewAltAzAsync": True, "CanSync": True, "CanSyncAltAz": False, "CanUnpark": True,
    "Declination": lambda v: 89 < v <= 90, "DeclinationRate": 0, "DoesRefraction": True,
    "EquatorialSystem": EquatorialCoordinateType.equJ2000, "FocalLength": 0.6, "GuideRateDeclination": lambda v: 0 < v < 0.01,
    "GuideRateRightAscension": lambda v: 0 < v < 0.01, "IsPulseGuiding": False, "RightAscension": lambda v: 0 <= v < 24,
    "RightAscensionRate": 0, "SideOfPier": lambda v: v in (PierSide.pierEast, PierSide.pierWest),
    "SiderealTime": lambda v: 0 <= v < 24, "SiteElevation": 200, "SiteLatitude": 34.725, "SiteLongitude": -86.64, "Slewing": False,
    "SlewSettleTime": 1, "TargetDeclination": Exception, "TargetRightAscension": Exception, "Tracking": False,
    "TrackingRate": DriveRates.driveSidereal, "TrackingRates": [0], "UTCDate": lambda v: v.year == 2018,
    "AxisRates": lambda v: v[0].Minimum == 0 and v[0].Maximum == 20, "CanMoveAxis": True,
    "DestinationSideOfPier": lambda v: v in (0, 1), "AbortSlew": None, "FindHome": None, "MoveAxis": InvalidValueException,
    "Park": None, "PulseGuide": InvalidOperationException, "SetPark": None,
    "SlewToAltAz": NotImplementedException, "SlewToCoordinates": NotImplementedException,  # alpyca does not ask the server
    "SlewToTarget": NotImplementedException, "SlewToAltAzAsync": InvalidValueException,
    "SlewToCoordinatesAsync": InvalidOperationException, "SlewToTargetAsync": Exception, "SyncToAltAz": NotImplementedException,
    "SyncToCoordinates": InvalidOperationException, "SyncToTarget": Exception, "Unpark": None}
GIVEN = {
    "Action": ("a",), "CommandBlind": ("a", True), "CommandBool": ("a", True), "CommandString": ("a", True),
    "StartExposure": (-1.0, True), "AxisRates": (TelescopeAxes.axisPrimary,), "CanMoveAxis": (TelescopeAxes.axisSecondary,),
    "DestinationSideOfPier": (3.0, 30.0), "MoveAxis": (TelescopeAxes.axisPrimary, 99.0),
    "SlewToAltAz": (180.0, 50.0), "SlewToCoordinates": (3.0, 30.0), "SlewToAltAzAsync": (180.0, 2.0),
    "SlewToCoordinatesAsync": (3.0, 30.0), "SyncToAltAz": (180.0, 50.0), "SyncToCoordinates": (3.0, 30.0),
    "PulseGuide": (GuideDirections.guideNorth, 100), "Move": (-5,), "CalibratorOn": (1,), "SensorDescription": ("Pressure",),
    "TimeSinceLastUpdate": ("",)}
OF_A_FOCUSER = {
    "Absolute": True, "IsMoving": False, "MaxIncrement": lambda v: v > 1000, "MaxStep": lambda v: v > 1000 and v % 2 == 0,
    "Position": lambda v: v > 500, "StepSize": 1, "TempComp": False, "TempCompAvailable": False, "Temperature": A_NUMBER,
    "Halt": None, "Move": InvalidValueException}
OF_A_WHEEL = {"FocusOffsets": [0] * 4, "Names": ["V", "bessell-B", "bessell-R", "clear"], "Position": 0}
OF_A_COVER = {
    "Brightness": NotImplementedException, "CalibratorState": CalibratorStatus.NotPresent, "CalibratorChanging": False,
    "CoverMoving": False, "CoverState": CoverStatus.Open, "MaxBrightness": NotImplementedException,
    "CalibratorOff": NotImplementedException, "CalibratorOn": NotImplementedException, "CloseCover": None, "HaltCover": None,
    "OpenCover": None}
OF_CONDITIONS = {
    "AveragePeriod": 0, "CloudCover": 0, "DewPoint": A_NUMBER, "Humidity": 50, "Pressure": lambda v: 980 < v < 1000,
    "RainRate": NotImplementedException, "SkyBrightness": lambda v: 0 < v < 0.1, "SkyQuality": lambda v: 18 < v < 21,
    "SkyTemperature": NotImplementedException, "StarFWHM": NotImplementedException, "Temperature": lambda v: 10 < v < 20,
    "WindDirection": NotImplementedException, "WindGust": NotImplementedException, "WindSpeed": NotImplementedException,
    "Refresh": None, "SensorDescription": A_TEXT, "TimeSinceLastUpdate": lambda v: 0 <= v <= 10}
# What is set, and what it raises.
SET = {
    "BinX": (1, None), "BinY": (9, InvalidValueException), "CoolerOn": (True, None), "FastReadout": (True, NotImplementedException),
    "Gain": (1, InvalidValueException), "NumX": (1024, None), "NumY": (1024, None), "Offset": (0, None),
    "ReadoutMode": (0, None), "SetCCDTemperature": (-300.0, InvalidValueException), "StartX": (0, None), "StartY": (0, None),
    "SubExposureDuration": (1.0, NotImplementedException), "Connected": (True, None),
    "DeclinationRate": (0.0, None), "DoesRefraction": (False, NotImplementedException), "GuideRateDeclination": (0.002, None),
    "GuideRateRightAscension": (-1.0, InvalidValueException), "RightAscensionRate": (0.0, None),
    "SideOfPier": (PierSide.pierEast, NotImplementedException), "SiteElevation": (1.0, NotImplementedException),
    "SiteLatitude": (1.0, NotImplementedException), "SiteLongitude": (1.0, NotImplementedException), "SlewSettleTime": (1, None),
    "TargetDeclination": (91.0, InvalidValueException), "TargetRightAscension": (24.5, InvalidValueException),
    "Tracking": (False, None), "TrackingRate": (DriveRates.driveLunar, InvalidValueException),
    "UTCDate": ("2020-01-01T00:00:00Z", NotImplementedException), "TempComp": (True, NotImplementedException),
    "Position": (9, InvalidValueException), "AveragePeriod": (1.0, InvalidValueException)}


def answer(call):
    try:
        return call()
    except Exception as raised:  # what alpyca makes of an error number
        return raised


def is_right(answered, expected):
    if inspect.isclass(expected):
        return isinstance(answered, expected)
    if isinstance(answered, Exception):
        return False
    if callable(expected):
        return bool(expected(answered))
    return answered == expected or expected is None


def members_of(device):
    return [name for kind in (Device, type(device)) for name, _ in inspect.getmembers(kind) if name[0] != "_" and name in
            kind.__dict__]


def settle(device, called):
    """After a member that leaves the device elsewhere: connected, at rest, not parked."""
    if called == "Disconnect":
        device.Connect()
    if called == "Park":
        wait_until(lambda: device.AtPark, "the park position")
        device.Unpark()
    if called in ("FindHome", "AbortSlew"):
        wait_until(lambda: not device.Slewing, "the end of the slew")
    if called in ("CloseCover", "HaltCover"):
        device.OpenCover()
    if called in ("CloseCover", "HaltCover", "OpenCover"):
        wait_until(lambda: device.CoverState == CoverStatus.Open, "the open cover")


def call_members(device, expected):
    """The members that answer rightly, and what the others answer."""
    right, wrong = [], {}
    for name in members_of(device):
        member = inspect.getattr_static(type(device), name)
        if isinstance(member, property):
            results = [(name, answer(lambda: getattr(device, name)), expected.get(name, ...))]
            if member.fset:
                value, raises = SET.get(name, (None, ...))
                results.append((f"{name} =", answer(lambda: setattr(device, name, value)), raises))
        else:
            results = [(name, answer(lambda: getattr(device, name)(*GIVEN.get(name, ()))), expected.get(name, ...))]
            settle(device, name)
        for called, answered, wanted in results:
            if is_right(answered, wanted):
                right.append(called)
            else:
                wrong[called] = answered
    return right, wrong


def answers_rightly(camera, telescope, others):
    total = right = 0
    focuser, wheel, cover, conditions = others
    for device, expected in ((telescope, OF_A_TELESCOPE), (camera, OF_A_CAMERA), (focuser, OF_A_FOCUSER), (wheel, OF_A_WHEEL),
                             (cover, OF_A_COVER), (conditions, OF_CONDITIONS)):
        good, bad = call_members(device, OF_DEVICES | expected)
        for name, answered in bad.items():
            print(f"   {type(device).__name__}.{name}: {answered!r}")
        right, total = right + len(good), total + len(good) + len(bad)
    check(right == total, f"{right} of {total} reads, writes and calls of alpyca's devices answer rightly")


def until_idle(telescope, what="Slewing"):
    wait_until(lambda: not getattr(telescope, what), f"the end of {what}")


def home_again(telescope):
    """After Park and FindHome of the members."""
    until_idle(telescope)
    telescope.Unpark()
    telescope.FindHome()
    until_idle(telescope)
    check(telescope.AtHome and not telescope.AtPark, "it is at home")


def image_of(camera, length_s):
    camera.StartExposure(length_s, True)
    wait_until(lambda: camera.ImageReady, "an image")
    return numpy.array(camera.ImageArray)


def slew(telescope, ra_h, dec_deg):
    telescope.SlewToCoordinatesAsync(ra_h, dec_deg)
    check(telescope.Slewing, "it slews")
    until_idle(telescope)


def points_and_exposes(camera, telescope, out):
    camera.Connected = telescope.Connected = True
    telescope.Tracking = True
    ra_h, dec_deg = telescope.SiderealTime - 1.0, 30.0
    ra_h %= 24
    slew(telescope, ra_h, dec_deg)
    check(abs(telescope.RightAscension - ra_h) * 15 < ARCSEC and abs(telescope.Declination - dec_deg) < ARCSEC,
          "it is where it was sent")
    image = image_of(camera, 1.0)
    frame = file_of(out, "telescope", 1)
    check(image.dtype == numpy.uint16 and image.shape == (1024, 1024), "images are 16-bit arrays [x][y]")
    check((image.T == frame.data).all(), "the image is that of the FITS file")
    centre = WCS(frame.header).pixel_to_world(511.5, 511.5)
    offset = centre.separation(type(centre)(ra_h * 15, dec_deg, unit="deg")).arcsec
    check(offset < 1.0, f"by astropy its centre is {offset:.2f} arcsec from where the telescope points")
    check(abs(camera.LastExposureDuration - 1.0) < 1e-6 and frame.header["DATE-BEG"].startswith(camera.LastExposureStartTime[:19]),
          "the last exposure is that of the file")

    camera.BinX = 2
    camera.StartX, camera.StartY, camera.NumX, camera.NumY = 100, 50, 200, 300
    image = image_of(camera, 0.5)
    whole = file_of(out, "telescope", 2).data.astype(int)
    binned = whole.reshape(512, 2, 512, 2).sum(axis=(1, 3)).clip(0, 65535)
    check((image.T == binned[50:350, 100:300]).all(), "binning adds the counts of a window")
    camera.BinX = 1
    camera.StartX = camera.StartY = 0
    camera.NumX = camera.NumY = 1024
    return ra_h, dec_deg


def last_frame(out, sensor="telescope"):
    return max(line["frame"] for line in journal(out) if line["sensor"] == sensor)


def moves_on(camera, telescope, out, place):
    camera.StartExposure(5.0, True)
    check(isinstance(answer(lambda: telescope.SlewToCoordinatesAsync(*place)), InvalidOperationException),
          "it does not slew while a shutter is open")
    time.sleep(0.3)
    camera.StopExposure()
    wait_until(lambda: camera.ImageReady, "the image of a stopped exposure")
    check(0.2 < camera.LastExposureDuration < 5, "an exposure can be stopped, and has its image")
    check(abs(file_of(out, "telescope", last_frame(out)).header["EXPTIME"] - camera.LastExposureDuration) < 1e-6, "its file says how long it was")
    camera.StartExposure(30.0, True)
    camera.AbortExposure()
    check(camera.CameraState == CameraStates.cameraIdle and not camera.ImageReady, "an exposure can be aborted")

    telescope.RightAscensionRate = 10.0  # 150 arcsec a second: a satellite's
    image_of(camera, 1.0)
    telescope.RightAscensionRate = 0.0
    telescope.SyncToCoordinates(place[0], place[1] + 0.1)
    check(abs(telescope.Declination - place[1] - 0.1) < ARCSEC, "it tells what it is told by a sync")
    telescope.PulseGuide(GuideDirections.guideNorth, 500)
    until_idle(telescope, "IsPulseGuiding")
    telescope.Tracking = False
    image_of(camera, 0.5)
    check("ra_deg" not in journal(out)[-1], "without tracking it stands still")
    telescope.Park()
    wait_until(lambda: telescope.AtPark, "the park position")
    check(isinstance(answer(lambda: setattr(telescope, "Tracking", True)), ParkedException), "parked, it does not track")


def around(image, place):
    """41 x 41 pixels about a place, without the sky."""
    return (image.astype(float) - numpy.median(image))[place[0] - 20:place[0] + 21, place[1] - 20:place[1] + 21]


def lone_star(image, below):
    """Row and column of the brightest star whose peak is below a count and that has a hundredth of it beside it at most."""
    far = numpy.hypot(*(numpy.indices((41, 41)) - 20)) > 5
    inner = image[40:-40, 40:-40]
    for index in numpy.argsort(inner, axis=None)[::-1]:
        row, column = (axis + 40 for axis in numpy.unravel_index(index, inner.shape))
        if image[row, column] >= below:
            continue
        part = around(image, (row, column))
        if part.max() == part[20, 20] and part[far].max() < 0.01 * part.max() + 200:
            return row, column
    raise Failure("no star stands alone")


def variance_of_star(image, place):
    """Mean variance of a star's light along an axis [px2], and its counts."""
    part = around(image, place)
    rows, columns = numpy.indices(part.shape)
    light = numpy.where(numpy.hypot(rows - 20, columns - 20) < 14, part, 0)
    total = light.sum()
    moments = [(light * (axis - (light * axis).sum() / total) ** 2).sum() / total for axis in (rows, columns)]
    return sum(moments) / 2, total


def changes_the_light(camera, telescope, others, out):
    """Filters, focus and cover. A star has about as many photons a nanometre all over a band of 408 to 792 nm. 150 um out of the focus of an f/2 with pixels of 13 um a point is a ring of 75 um, 5.77 px,
    and 0.4 of that: its variance along an axis is radius^2 (1 + 0.4^2) / 4."""
    focuser, wheel, cover, _ = others
    in_focus = image_of(camera, 2.0).T
    star = lone_star(in_focus, 60000)
    sharp, light = variance_of_star(in_focus, star)
    centre = focuser.Position
    focuser.Move(centre + 150)
    check(focuser.IsMoving and isinstance(answer(lambda: camera.StartExposure(1.0, True)), InvalidOperationException),
          "no exposure begins while the focuser moves")
    wait_until(lambda: not focuser.IsMoving, "the focuser")
    camera.StartExposure(2.0, True)
    check(isinstance(answer(lambda: focuser.Move(centre)), InvalidOperationException) and
          isinstance(answer(lambda: setattr(wheel, "Position", 1)), InvalidOperationException) and
          isinstance(answer(cover.CloseCover), InvalidOperationException), "nothing moves while a shutter is open")
    wait_until(lambda: camera.ImageReady, "an image")
    blurred, spread_light = variance_of_star(numpy.array(camera.ImageArray).T, star)
    ring = (150 / 2 / 13 / 2) ** 2 * (1 + 0.4 ** 2) / 4
    check(abs(blurred - sharp - ring) < 0.15 * ring and abs(spread_light / light - 1) < 0.05,
          f"out of focus the variance of a star grows by {blurred - sharp:.2f} px2, by geometry {ring:.2f}; it has {spread_light / light:.3f} of its light")
    focuser.Move(centre)
    wait_until(lambda: not focuser.IsMoving, "the focuser")

    in_v = image_of(camera, 2.0).T
    wheel.Position = 3
    check(wheel.Position == -1, "the wheel turns")
    wait_until(lambda: wheel.Position == 3, "the filter")
    star = lone_star(in_v, 12000)
    ratio = around(image_of(camera, 2.0).T, star)[12:29, 12:29].sum() / around(in_v, star)[12:29, 12:29].sum()
    check(2.3 < ratio < 3.7, f"through a filter of three times the width a star has {ratio:.2f} times the light")
    names = {line["frame"]: line["filter"] for line in journal(out) if line["sensor"] == "telescope"}
    last = max(names)
    check(file_of(out, "telescope", last).header["FILTER"] == "clear" and names[last] == 3, "the file says which")
    wheel.Position = 0
    cover.CloseCover()
    wait_until(lambda: cover.CoverState == CoverStatus.Closed and wheel.Position == 0, "the cover")
    covered = image_of(camera, 2.0)
    check(abs(covered.mean() - 300) < 2 and covered.max() < 400, f"behind the cover there is the bias, {covered.mean():.1f} DN")
    check(file_of(out, "telescope", last + 1).header["DARK"], "and the file says so")
    cover.OpenCover()
    wait_until(lambda: cover.CoverState == CoverStatus.Open, "the cover")
    camera.StartExposure(0.5, False)
    wait_until(lambda: camera.ImageReady, "an image")
    check(numpy.array(camera.ImageArrayRaw).max() < 400, "nor comes light through a shutter that stays closed")


def latency(camera, out, frames=5):
    """Seconds from an exposure's end to the image of 1 megapixel at the client."""
    seconds = []
    for _ in range(frames):
        end = time.monotonic() + 3.0
        camera.StartExposure(3.0, True)
        wait_until(lambda: camera.ImageReady, "an image")
        raw = camera.ImageArrayRaw
        seconds.append(time.monotonic() - end)
        check(len(raw) == 1024 * 1024, "an image of 1 megapixel")
    print(f"   from an exposure's end to its image at the client: {sorted(seconds)[len(seconds) // 2]:.3f} s, "
          f"at most {max(seconds):.3f} s")


def random_requests(address, count, seed=1):
    """Requests that are right, nearly right or none; each is answered, and nothing ends."""
    draw = random.Random(seed)
    host, port = address.split(":")
    devices = (Camera, Telescope, Focuser, FilterWheel, CoverCalibrator, ObservingConditions)
    names = [(device.__name__.lower(), name.lower()) for device in devices for kind in (Device, device)
             for name in kind.__dict__ if name[0] != "_" and (not name.startswith("SlewTo") or name.endswith("Async"))]
    values = ["0", "1", "-1", "true", "False", "", "nan", "1e308", "12.5", "999999999999", "%00", "%zz", "\u00e9", "a" * 300]
    others = ["ClientID", "ClientTransactionID", "Duration", "Light", "Axis", "Rate", "Direction", "RightAscension", "Declination",
              "Position", "Brightness", "SensorName"]

    def request():
        kind = draw.random()
        if kind < 0.02:
            return draw.randbytes(draw.randrange(1, 300)) + b"\r\n\r\n"
        device, member = draw.choice(names)
        target = f"/api/v1/{device}/{draw.choice('00000011117')}/{member}"
        if kind < 0.05:
            target = "/" + "".join(draw.choices("apimngetu/v1?&=%.", k=30))
        keys = [member, *draw.choices(others, k=draw.randrange(4))]
        form = "&".join(f"{key}={draw.choice(values[:5] if kind < 0.8 else values)}" for key in keys)
        if draw.random() < 0.6:
            return f"GET {target}?{form} HTTP/1.1\r\nHost: localhost\r\n\r\n".encode()
        body = form.encode()
        return f"PUT {target} HTTP/1.1\r\nHost: localhost\r\nContent-Length: {len(body)}\r\n\r\n".encode() + body

    statuses, link = collections.Counter(), None
    for _ in range(count):
        link = link or socket.create_connection((host, int(port)), timeout=30)
        try:
            link.sendall(request())
            head = link.recv(1 << 16)
            while head and b"\r\n\r\n" not in head:
                head += link.recv(1 << 16)
            length = re.search(rb"Content-Length: (\d+)", head)
            body = len(head) - head.find(b"\r\n\r\n") - 4
            while length and body < int(length.group(1)):
                body += len(link.recv(1 << 20))
            statuses[head[9:12].decode() or "closed"] += 1
            if not head.startswith(b"HTTP/1.1 200"):
                link = link.close()
        except ConnectionError:
            statuses["closed"] += 1
            link = link.close()
    check(sum(statuses.values()) == count and not any(status.startswith("5") for status in statuses),
          f"{count} random requests end nothing: {dict(statuses)}")


def needs_tokens(binary, directory):
    """alpyca gives the token as the password in the address."""
    tokens = directory / "tokens"
    tokens.write_text(f"view {'v' * 20}\noperator {'o' * 20}\n")
    tokens.chmod(0o600)
    with Served(binary, directory / "tokens-night", "--tokens", tokens, "--no-discovery") as served:
        def connected(who):
            device = Telescope(who + served.address, 0)
            return answer(lambda: setattr(device, "Connected", True)), answer(lambda: device.Connected)
        check(all(isinstance(a, AlpacaRequestException) for a in (*connected(""), *connected(f"me:{'x' * 20}@"))), "no token, no answer")
        change, look = connected(f"me:{'v' * 20}@")
        check(isinstance(change, AlpacaRequestException) and look is False, "the view token reads, and changes nothing")
        check(connected(f"me:{'o' * 20}@") == (None, True), "the operator's does both")


def test(binary, directory):
    out, port = directory / "night", free_udp_port()
    with Served(binary, out, "--slew-rate", "20", "--discovery-port", str(port)) as served:
        check(is_discovered(served.address, port), "alpyca discovers it")
        check([d["DeviceType"] for d in management.configureddevices(served.address)] ==
              ["Telescope", "Camera", "Focuser", "FilterWheel", "CoverCalibrator", "ObservingConditions"] * 2,
              "it has two telescopes and two cameras, each with what belongs to it")
        check(management.apiversions(served.address) == [1] and management.description(served.address)["ServerName"], "it is managed")
        camera, telescope = Camera(served.address, 0), Telescope(served.address, 0)
        check(isinstance(answer(lambda: camera.CameraXSize), NotConnectedException), "devices must be connected")
        check(isinstance(answer(lambda: Camera(served.address, 2).CameraXSize), AlpacaRequestException), "there is no third camera")
        camera.Connect()
        telescope.Connect()
        others = [kind(served.address, 0) for kind in (Focuser, FilterWheel, CoverCalibrator, ObservingConditions)]
        for other in others:
            other.Connect()
        answers_rightly(camera, telescope, others)
        home_again(telescope)
        place = points_and_exposes(camera, telescope, out)
        changes_the_light(camera, telescope, others, out)
        moves_on(camera, telescope, out, place)
        if "--figures" in sys.argv:
            latency(camera, out)
        wide = Camera(served.address, 1)
        wide.Connected = True
        image = image_of(wide, 0.5)
        check((image.T == file_of(out, "wide", 1).data).all(), "the second camera has its image, too")
        random_requests(served.address, argument("--requests", 2000))
        wait_until(lambda: answer(lambda: camera.CameraState) in (CameraStates.cameraIdle, CameraStates.cameraExposing)
                   or isinstance(answer(lambda: camera.CameraState), NotConnectedException), "the camera after random requests")
    check(served.process.returncode == 0, "Ctrl-C ends the night")
    same_again(binary, out, directory)
    needs_tokens(binary, directory)


def is_discovered(address, port):
    """alpyca's search, at a port of the test's."""
    before = alpaca.discovery.port
    alpaca.discovery.port = port
    try:
        return address in alpaca.discovery.search_ipv4(numquery=1, timeout=1)
    finally:
        alpaca.discovery.port = before


if __name__ == "__main__":
    main(test)
