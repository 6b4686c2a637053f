"""A tracker of Stone Soup in a run: two sites find objects, a telescope follows the one known worst. tracker_stonesoup.yaml starts it."""
import datetime
import dmise
import numpy as np
from dmise.stonesoup import TriangulationInitiator, TwoBodyJ2, to_stonesoup
from stonesoup.dataassociator.neighbour import GNNWith2DAssignment
from stonesoup.deleter.time import UpdateTimeDeleter
from stonesoup.hypothesiser.distance import DistanceHypothesiser
from stonesoup.measures import Mahalanobis
from stonesoup.predictor.kalman import UnscentedKalmanPredictor
from stonesoup.tracker.simple import MultiTargetTracker
from stonesoup.types.update import Update
from stonesoup.updater.kalman import UnscentedKalmanUpdater

@dmise.tracker
class Soup:
    def __init__(self):
        self.predictor, self.ids = UnscentedKalmanPredictor(TwoBodyJ2()), {}  # Stone Soup's name of a track, and ours
        gate = DistanceHypothesiser(self.predictor, UnscentedKalmanUpdater(), Mahalanobis(), missed_distance=5)
        self.tracker = MultiTargetTracker(TriangulationInitiator(), UpdateTimeDeleter(datetime.timedelta(seconds=60)), None,
                                          GNNWith2DAssignment(gate), gate.updater)

    def __call__(self, t_s, frames, world, options):
        sets, taken = {}, {}
        for d in (d for frame in frames for d in frame.detections):
            sets.setdefault((d.time_ns, d.sensor), set()).add(to_stonesoup(d, options["sigma_arcsec"]))
        for key in sorted(sets):
            _, tracks = self.tracker.update_tracker(next(iter(sets[key])).timestamp, sets[key])
            updated = [t for t in tracks if isinstance(t.state, Update) and t.state.hypothesis.measurement in sets[key]]
            for track in sorted(updated, key=lambda t: t.state.hypothesis.measurement.metadata["id"]):
                number = self.ids.setdefault(track.id, len(self.ids) + 1)
                taken.setdefault(number, []).append(track.state.hypothesis.measurement.metadata["id"])
        now_utc = world.time_utc.replace(tzinfo=None)
        now = {self.ids[t.id]: self.predictor.predict(t.state, timestamp=now_utc) for t in self.tracker.tracks}
        said = [dmise.Track(id=n, status="confirmed", position_m=s.state_vector[:3], velocity_m_per_s=s.state_vector[3:],
                            covariance=s.covar, associated=taken.get(n, [])) for n, s in now.items()]
        worst = max(now, key=lambda n: np.trace(now[n].covar[:3, :3]), default=None)
        return dmise.Tracks(said, tasks=[dmise.Point("telescope", track=worst)] if worst else [])

dmise.serve(Soup)
