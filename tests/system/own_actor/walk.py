"""An actor with a memory: its velocity changes at each tick by a random number. It keeps checkpoints."""
import random

import dmise
import mortal
import numpy as np


@dmise.actor("probe")
class Walk:
    def __init__(self):
        self.t_s = 0.0
        self.state = np.array([7178112.0, -2810.0, 18581.0, -19.5, -1114.3, 7368.0])

    def __call__(self, t_s, world, options):
        mortal.maybe_die(world.tick, options)
        push = 0.01 * random.Random(world.tick).random()
        pull = -3.986004415e14 * self.state[:3] / np.linalg.norm(self.state[:3]) ** 3
        dt = t_s - self.t_s
        self.state[:3] += dt * self.state[3:] + dt * dt / 2 * pull
        self.state[3:] += dt * pull + push
        self.t_s = t_s
        brighter = 2.0 if world.tick >= options.get("bright_from", 1e9) else 1.0
        return dmise.State(position_m=self.state[:3], velocity_m_per_s=self.state[3:],
                           albedo=brighter * options["albedo"] if "albedo" in options else None)

    def checkpoint(self):
        return np.append(self.state, self.t_s).tobytes()

    def restore(self, kept):
        numbers = np.frombuffer(kept)
        self.state, self.t_s = numbers[:6].copy(), float(numbers[6])


if __name__ == "__main__":
    dmise.serve(Walk)
