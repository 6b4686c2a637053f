"""A satellite that fires its engine along its velocity. manoeuvre.yaml starts it; docs/howto/plug-in-a-model.md explains it."""
import dmise
import numpy as np

GM = 3.986004415e14  # m^3/s^2


@dmise.actor("chaser")
class Chaser:
    def __init__(self):
        self.state, self.t_s = None, 0.0

    def __call__(self, t_s, world, options):
        if self.state is None:
            self.state = np.array(options["position_m"] + options["velocity_m_per_s"])
        while self.t_s < t_s:
            step_s = min(1.0, t_s - self.t_s)
            burns = options["burn_from_s"] <= self.t_s < options["burn_to_s"]
            self.state = moved(self.state, step_s, burns * options["thrust_m_per_s2"])
            self.t_s += step_s
        return dmise.State(position_m=self.state[:3], velocity_m_per_s=self.state[3:])

    def checkpoint(self):
        return np.append(self.state, self.t_s).tobytes()

    def restore(self, kept):
        self.state, self.t_s = np.frombuffer(kept)[:6].copy(), float(np.frombuffer(kept)[6])


def moved(state, h, thrust_m_per_s2):
    """One step of Runge and Kutta."""
    def rate(s):
        return np.append(s[3:], -GM * s[:3] / np.linalg.norm(s[:3])**3 + thrust_m_per_s2 * s[3:] / np.linalg.norm(s[3:]))
    a = rate(state)
    b = rate(state + h / 2 * a)
    c = rate(state + h / 2 * b)
    return state + h / 6 * (a + 2 * b + 2 * c + rate(state + h * c))


dmise.serve(Chaser)
