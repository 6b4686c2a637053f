"""A satellite that fires its engine along its velocity, by scipy. manoeuvre.yaml starts it; docs/howto/plug-in-a-model.md explains it."""
import dmise
import numpy as np
from scipy.integrate import solve_ivp

GM = 3.986004415e14  # m^3/s^2


def rate(t_s, state, thrust_m_per_s2):
    position, velocity = state[:3], state[3:]
    along = velocity / np.linalg.norm(velocity)
    return np.append(velocity, thrust_m_per_s2 * along - GM * position / np.linalg.norm(position)**3)


@dmise.actor("chaser")
class Chaser:
    def __init__(self):
        self.state, self.t_s = None, 0.0

    def __call__(self, t_s, world, options):
        if self.state is None:
            self.state = np.array(options["position_m"] + options["velocity_m_per_s"])
        begin_s, end_s = options["burn_from_s"], options["burn_to_s"]
        for until_s in sorted({begin_s, end_s, t_s}):  # the engine is on or off over the whole of each step
            if self.t_s < until_s <= t_s:
                thrust_m_per_s2 = options["thrust_m_per_s2"] if begin_s <= self.t_s < end_s else 0.0
                orbit = solve_ivp(rate, (self.t_s, until_s), self.state, "DOP853", args=(thrust_m_per_s2,), rtol=1e-12, atol=1e-6)
                self.state, self.t_s = orbit.y[:, -1], until_s
        return dmise.State(position_m=self.state[:3], velocity_m_per_s=self.state[3:])

    def checkpoint(self):
        return np.append(self.state, self.t_s).tobytes()

    def restore(self, kept):
        *self.state, self.t_s = np.frombuffer(kept)


dmise.serve(Chaser)
