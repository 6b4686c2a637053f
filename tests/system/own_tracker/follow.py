"""A tracker that remembers all that it hears: its one track passes over the sensor `ground`, and is displaced by what was heard.

It ends itself at ticks of `options`, each once: what it lived through is in a file.
"""
import os
import pathlib
import pickle
import signal
import time
import zlib

import dmise
import numpy as np
from dmise.dynamics import propagate

POLE = np.array([0.0, 0.0, 1.0])
SIGMAS = np.array([100.0] * 3 + [1.0] * 3)


def end_at(tick, options):
    if "lives" not in options:
        return
    lives = pathlib.Path(options["lives"])
    lives.touch()
    lived = len(lives.read_text())
    if lived < len(options["ends"]) and tick >= options["ends"][lived]:
        lives.write_text((lived + 1) * "x")
        os.kill(os.getpid(), getattr(signal, options["how"][lived]))


class Follow:
    def __init__(self):
        self.heard, self.start = 0, None

    def hear(self, frames, world):
        for frame in frames:
            said = repr([frame.report.sensor, frame.report.frame, frame.report.middle_ns, frame.report.background_e,
                         [(d.id, d.ra_rad, d.snr) for d in frame.detections], world.environment.sun_m.tolist()])
            self.heard = zlib.crc32(said.encode(), self.heard)
            if frame.report.sensor == "ground" and self.start is None:
                up = frame.report.sensor_position_m / np.linalg.norm(frame.report.sensor_position_m)
                east = np.cross(POLE, up) / np.linalg.norm(np.cross(POLE, up))
                self.start = np.concatenate([7.4e6 * up, 7340.0 * east]), frame.report.middle_ns

    def __call__(self, t_s, frames, world, options):
        end_at(world.tick, options)
        time.sleep(options.get("sleep_s", 0))
        self.hear(frames, world)
        if self.start is None:
            return []
        state = propagate(self.start[0][:, None], (world.time_ns - self.start[1]) / 1e9 - 40, POLE)[:, 0]
        state[:3] += self.heard % 1000 / 10
        taken = [d.id for frame in frames for d in frame.detections][:1]
        tracks = [dmise.Track(id=1, status="confirmed", position_m=state[:3], velocity_m_per_s=state[3:],
                              covariance=np.diag(SIGMAS**2), associated=taken)]
        return dmise.Tracks(tracks, [dmise.Point("scope", 1, 2)]) if options.get("tasks", True) else tracks


@dmise.tracker
class Remembering(Follow):
    def checkpoint(self):
        return pickle.dumps((self.heard, self.start))

    def restore(self, saved):
        self.heard, self.start = pickle.loads(saved)


if __name__ == "__main__":
    dmise.serve(Remembering)
