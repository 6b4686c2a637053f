"""A tracker of one's own: the orbit of one object by least squares, and a telescope that follows it. tracker_node.yaml starts it."""
import pickle
import dmise
import numpy as np
from dmise.dynamics import apparent_direction, pole_of, propagate
from dmise.orbit_fit import fit_orbit, is_bound, triangulate, velocity_between

@dmise.tracker
class OneObject:
    def __init__(self): self.state, self.sights, self.pairs = None, [], []  # a pair: two lines of sight, and where they meet
    def checkpoint(self): return pickle.dumps(self.__dict__)
    def restore(self, saved): self.__dict__.update(pickle.loads(saved))

    def begin(self, a, b, pole):
        there = triangulate(a, b)
        if there is None or there.miss_squared > 16: return
        for sights, before in [pair for pair in self.pairs if pair[0][0].time_ns < a.time_ns]:
            v = velocity_between(before.position_m, there.position_m, (a.time_ns - sights[0].time_ns) / 1e9, pole)
            state = np.concatenate([there.position_m, v])
            if is_bound(state) and fit_orbit([*sights, a, b], state, a.time_ns, pole).chi_squared < 16:
                self.state, self.time_ns, self.sights = state, a.time_ns, [*sights]
        self.pairs.append(((a, b), there))

    def __call__(self, t_s, frames, world, options):
        pole, found = pole_of(world.time_utc), [(d, dmise.line_of_sight(d)) for frame in frames for d in frame.detections]
        for d, sight in found: sight.covariance_rad2 = sight.covariance_rad2 + (options["sigma_arcsec"] / 206265)**2 * np.eye(2)
        for (d, a), (e, b) in [(one, two) for one in found for two in found] if self.state is None else ():
            if d.sensor < e.sensor and d.time_ns == e.time_ns: self.begin(a, b, pole)
        if self.state is None: return []
        moved = lambda time_ns: propagate(self.state[:, None], (time_ns - self.time_ns) / 1e9, pole)
        off_rad = lambda sight: np.linalg.norm(sight.direction - apparent_direction(moved(sight.time_ns), sight.origin_m)[:, 0])
        near = [(d, sight) for d, sight in found if off_rad(sight) < np.radians(options["gate_deg"])]
        self.sights += [sight for _, sight in near]
        orbit = fit_orbit(self.sights, moved(world.time_ns)[:, 0], world.time_ns, pole)
        self.state, self.time_ns = orbit.state, world.time_ns
        track = dmise.Track(id=1, status="confirmed", position_m=orbit.state[:3], velocity_m_per_s=orbit.state[3:],
                            covariance=orbit.covariance, associated=[d.id for d, _ in near])
        return dmise.Tracks([track], tasks=[dmise.Point("telescope", track=1)])

dmise.serve(OneObject)
