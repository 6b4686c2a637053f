"""Shows a live run in Rerun: rerun_view.py MASTER_ADDRESS ARCSEC [RUN_DIRECTORY|- [FILE.rrd, instead of the viewer]].

Frames come from the sensors (needs astropy), those of a replay from the run's directory; detections and lines of sight from the wire,
tracks from Stone Soup.
"""
import datetime, sys, threading
import dmise
import numpy as np
import rerun as rr
from dmise.stonesoup import DetectionReader, TriangulationInitiator, TwoBodyJ2
from stonesoup.dataassociator.neighbour import GNNWith2DAssignment
from stonesoup.deleter.time import UpdateTimeDeleter
from stonesoup.hypothesiser.distance import DistanceHypothesiser
from stonesoup.measures import Mahalanobis
from stonesoup.predictor.kalman import UnscentedKalmanPredictor
from stonesoup.tracker.simple import MultiTargetTracker
from stonesoup.updater.kalman import UnscentedKalmanUpdater

def show_frames(address, directory=None):
    for frame in dmise.frames(address, directory=None if directory == "-" else directory, raise_on_failure=False):
        low, high = np.percentile(frame.image, (1, 99.9))
        rr.set_time("utc", timestamp=frame.report.middle_utc)
        rr.log(f"{frame.report.sensor}/frame", rr.Image((255 * np.clip((frame.image - low) / (high - low), 0, 1)).astype(np.uint8)))

def show(records):
    rr.set_time("utc", timestamp=records[0].time_utc)
    rr.log(f"{records[0].sensor}/frame/detections", rr.Points2D([(d.x_px, d.y_px) for d in records]))
    sights = [dmise.line_of_sight(d) for d in records]
    rr.log(f"space/{records[0].sensor}", rr.Arrows3D(origins=[s.origin_m / 1e3 for s in sights], vectors=[s.direction * 1e3 for s in sights]))

rr.init("dmise", spawn=len(sys.argv) < 5)
rr.save(sys.argv[4]) if len(sys.argv) > 4 else None
threading.Thread(target=show_frames, args=[sys.argv[1], *sys.argv[3:4]]).start()  # the program ends when both have
gate = DistanceHypothesiser(UnscentedKalmanPredictor(TwoBodyJ2()), UnscentedKalmanUpdater(), Mahalanobis(), missed_distance=5)
reader = DetectionReader(sys.argv[1], sigma_arcsec=float(sys.argv[2]), heard=show)
for time, tracks in MultiTargetTracker(TriangulationInitiator(), UpdateTimeDeleter(datetime.timedelta(seconds=60)), reader,
                                       GNNWith2DAssignment(gate), gate.updater):
    for track in tracks:
        rr.log(f"space/track-{track.id[:8]}", rr.LineStrips3D([[np.ravel(s.state_vector)[:3].astype(float) / 1e3 for s in track]]))
