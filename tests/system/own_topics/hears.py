"""An actor that is pushed by what it hears of others, and tells it. It keeps checkpoints."""
import sys

import dmise
import mortal
import numpy as np


class Hears:
    def __init__(self):
        self.state = np.array([7178112.0, -2810.0, 18581.0, -19.5, -1114.3, 7368.0, 0.0])  # and the time

    def __call__(self, t_s, world, options):
        mortal.maybe_die(world.tick, options)
        for topic, records in world.topics.items():
            for record in records:
                print("heard", world.tick, topic, getattr(record, "id", getattr(record, "frame", "")))
        pull = -3.986004415e14 * self.state[:3] / np.linalg.norm(self.state[:3]) ** 3
        h, self.state[6] = t_s - self.state[6], t_s
        self.state[:3] += h * self.state[3:6] + h * h / 2 * pull
        self.state[3:6] += h * pull
        for detection in world.heard("detection/"):
            self.state[3:6] += options.get("push_m_per_s", 0.0) * detection.x_px / 100
        for track in world.heard("track/fusion-node"):
            self.state[3] += options.get("push_m_per_s", 0.0) * (track.position_m[0] % 1000) / 1000
        return dmise.State(position_m=self.state[:3], velocity_m_per_s=self.state[3:6])


class Remembers(Hears):
    def checkpoint(self):
        return self.state.tobytes()

    def restore(self, kept):
        self.state = np.frombuffer(kept).copy()


dmise.serve(dmise.actor("probe")(Hears if "forgetful" in sys.argv else Remembers))
