"""A satellite that fires its engine when a sensor has seen it. evade.yaml starts it; docs/howto/plug-in-a-model.md explains it."""
import dmise
import numpy as np

GM = 3.986004415e14  # m^3/s^2


@dmise.actor("chaser")
class Chaser:
    def __init__(self):
        self.state, self.t_s, self.burns_to_s = None, 0.0, 0.0

    def __call__(self, t_s, world, options):
        if self.state is None:
            self.state = np.array(options["position_m"] + options["velocity_m_per_s"])
        sights = [dmise.line_of_sight(detection) for detection in world.heard("detection/")]
        if any(self.is_seen_by(sight, np.radians(options["gate_deg"])) for sight in sights):
            self.burns_to_s = t_s + options["burn_s"]
        h, self.t_s = t_s - self.t_s, t_s
        thrust = options["thrust_m_per_s2"] * (t_s < self.burns_to_s)
        pull = -GM * self.state[:3] / np.linalg.norm(self.state[:3])**3
        away = np.cross(self.state[:3], self.state[3:]) / np.linalg.norm(np.cross(self.state[:3], self.state[3:]))
        self.state[:3] += h * self.state[3:] + h * h / 2 * (pull + thrust * away)
        self.state[3:] += h * (pull + thrust * away)
        return dmise.State(position_m=self.state[:3], velocity_m_per_s=self.state[3:])

    def is_seen_by(self, sight, gate_rad):
        there = self.state[:3] - (self.t_s - sight.time_ns / 1e9) * self.state[3:] - sight.origin_m
        return np.linalg.norm(there / np.linalg.norm(there) - sight.direction) < gate_rad

    def checkpoint(self):
        return np.append(self.state, [self.t_s, self.burns_to_s]).tobytes()

    def restore(self, kept):
        numbers = np.frombuffer(kept)
        self.state, self.t_s, self.burns_to_s = numbers[:6].copy(), float(numbers[6]), float(numbers[7])


dmise.serve(Chaser)
