"""Tracks an object of a live run with numpy: tracker.py MASTER_ADDRESS ARCSEC, the error of the sensors' pointing."""
import sys
import dmise
import numpy as np
from dmise.dynamics import apparent_direction, pole_of, propagate
from dmise.orbit_fit import fit_orbit, is_bound, triangulate, velocity_between

POINTING = (float(sys.argv[2]) / 206264.8) ** 2 * np.eye(2)
STEPS = np.diag([10.0] * 3 + [0.01] * 3)  # steps of derivatives: m, m/s

def derivative(function, x):
    return np.column_stack([(function((x + d)[:, None]) - function((x - d)[:, None]))[:, 0] / 2 / d.sum() for d in STEPS])

def begin(sights, pairs, pole):
    """The orbit of an object that two sites have seen twice, or None. A pair: time, two lines of sight, where they meet."""
    for a, b in ((a, b) for a in sights for b in sights if a.sensor < b.sensor and a.time_ns == b.time_ns):
        meeting = triangulate(a, b)
        for time_ns, before, there in [p for p in pairs if p[0] < a.time_ns] if meeting and meeting.miss_squared < 16 else ():
            v = velocity_between(there.position_m, meeting.position_m, (a.time_ns - time_ns) / 1e9, pole)
            if is_bound(start := np.concatenate([meeting.position_m, v])):
                orbit = fit_orbit([*before, a, b], start, a.time_ns, pole)
                if orbit.chi_squared < 16:
                    return orbit.state, orbit.covariance, a.time_ns
        pairs += [(a.time_ns, (a, b), meeting)] if meeting and meeting.miss_squared < 16 else []

track, pairs = None, []
for tick, messages in (subscription := dmise.subscribe(sys.argv[1], "detection/")).ticks():
    sights = [dmise.line_of_sight(d) for message in messages for d in subscription.records_of(message)]
    for sight, d in zip(sights, (d for message in messages for d in message.records)):
        sight.sensor, sight.covariance_rad2, pole = d.sensor, sight.covariance_rad2 + POINTING, pole_of(d.time_utc)
    for s in sorted(sights, key=lambda s: s.time_ns) if track else ():
        move = lambda x: propagate(x, (s.time_ns - track[2]) / 1e9, pole)
        see = lambda x: s.tangents @ (seen := apparent_direction(x, s.origin_m)) / (s.direction @ seen)
        F, x = derivative(move, track[0]), move(track[0][:, None])[:, 0]
        P, H, r = F @ track[1] @ F.T, derivative(see, x), -see(x[:, None])[:, 0]
        K = P @ H.T @ np.linalg.inv(S := H @ P @ H.T + s.covariance_rad2)
        if r @ np.linalg.solve(S, r) < 25:
            track = x + K @ r, P - K @ H @ P, s.time_ns
            print(s.time_ns / 1e9, *track[0], flush=True)
    track = track or begin(sights, pairs, pole) if sights else track
