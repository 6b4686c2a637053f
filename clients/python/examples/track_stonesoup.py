"""Tracks objects of a live run with Stone Soup: track_stonesoup.py MASTER_ADDRESS ARCSEC, the error of the sensors' pointing."""
import datetime, sys
from stonesoup.dataassociator.neighbour import GNNWith2DAssignment
from stonesoup.deleter.time import UpdateTimeDeleter
from stonesoup.hypothesiser.distance import DistanceHypothesiser
from stonesoup.measures import Mahalanobis
from stonesoup.predictor.kalman import UnscentedKalmanPredictor
from stonesoup.tracker.simple import MultiTargetTracker
from stonesoup.updater.kalman import UnscentedKalmanUpdater
from dmise.stonesoup import DetectionReader, TriangulationInitiator, TwoBodyJ2
gate = DistanceHypothesiser(UnscentedKalmanPredictor(TwoBodyJ2()), UnscentedKalmanUpdater(), Mahalanobis(), missed_distance=5)
tracker = MultiTargetTracker(TriangulationInitiator(), UpdateTimeDeleter(datetime.timedelta(seconds=60)), DetectionReader(
    sys.argv[1], sigma_arcsec=float(sys.argv[2])), GNNWith2DAssignment(gate), gate.updater)
for time, track in ((time, track) for time, tracks in tracker for track in tracks):
    print(time.isoformat(), track.id[:8], len(track), *map(float, track.state_vector), flush=True)
