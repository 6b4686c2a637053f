"""An external scheduler: points an Alpaca telescope at what a live run's fusion has found in no catalogue, follows it and exposes.

    scheduler.py MASTER_ADDRESS ALPACA_ADDRESS IMAGES EXPOSURE_S

Prints a line of JSON for each image: the track, when it was given and when the exposure began, where the telescope pointed.
"""
import datetime
import itertools
import json
import math
import sys
import time

import astropy.units as u
import dmise
import numpy as np
from alpaca.camera import Camera
from alpaca.telescope import Telescope
from astropy.coordinates import EarthLocation
from astropy.time import Time
from astropy.utils import iers
from dmise.dynamics import apparent_direction, pole_of, propagate

FIRST_LEAD_S, LEAD_S = 12.0, 3.0  # for a slew across the sky, and for the short one after it
SIDEREAL = 1.00273791  # sidereal seconds a second
iers.conf.auto_download = False


def place(track, site, utc):
    """Right ascension and declination [deg] of a track among the stars, from a site."""
    state = np.concatenate([track.position_m, track.velocity_m_per_s])[:, None]
    state = propagate(state, (utc - track.time_utc).total_seconds(), pole_of(utc))
    x, y, z = apparent_direction(state, site.get_gcrs_posvel(Time(utc))[0].xyz.to_value(u.m))[:, 0]
    return math.degrees(math.atan2(y, x)) % 360, math.degrees(math.asin(z))


def newest(subscription):
    """The last state of an object that is in no catalogue, of those that have come; waits for the first."""
    for message in subscription.messages():
        tracks = subscription.records_of(message)
        while (message := subscription.receive(0.0)) is not None:
            tracks += subscription.records_of(message)
        if tracks := [t for t in tracks if not t.catalogue_number and t.status != "lost"]:
            yield max(tracks, key=lambda t: (t.time_ns, t.detections))


def go_to(telescope, clock, track, site):
    """Slews ahead of the object, and follows it from when it comes by; returns where that was [deg]."""
    telescope.RightAscensionRate = telescope.DeclinationRate = 0.0
    for lead_s in itertools.chain([FIRST_LEAD_S], itertools.repeat(LEAD_S)):
        meeting = clock() + datetime.timedelta(seconds=lead_s)
        ra, dec = place(track, site, meeting)
        telescope.SlewToCoordinatesAsync(ra / 15, dec)
        while telescope.Slewing:
            time.sleep(0.02)
        if clock() < meeting:
            break
    before, after = (place(track, site, meeting + datetime.timedelta(seconds=s)) for s in (-0.5, 0.5))
    while clock() < meeting:
        time.sleep(0.01)
    telescope.RightAscensionRate = math.remainder(after[0] - before[0], 360) * 240 / SIDEREAL  # seconds of time
    telescope.DeclinationRate = (after[1] - before[1]) * 3600
    return ra, dec


def main(master, alpaca, images, exposure_s):
    telescope, camera = Telescope(alpaca, 0), Camera(alpaca, 0)
    telescope.Connected = camera.Connected = telescope.Tracking = True
    site = EarthLocation.from_geodetic(telescope.SiteLongitude, telescope.SiteLatitude, telescope.SiteElevation)
    clock = lambda: telescope.UTCDate.replace(tzinfo=datetime.timezone.utc)  # noqa: E731
    with dmise.subscribe(master, "track/") as subscription:
        for track in itertools.islice(newest(subscription), images):
            ra, dec = go_to(telescope, clock, track, site)
            camera.StartExposure(exposure_s, True)
            while not camera.ImageReady:
                time.sleep(0.02)
            print(json.dumps({"track": track.id, "given_utc": track.time_utc.isoformat(), "start_utc": camera.LastExposureStartTime,
                              "ra_deg": ra, "dec_deg": dec, "shape": np.shape(camera.ImageArray)}), flush=True)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], int(sys.argv[3]), float(sys.argv[4]))
