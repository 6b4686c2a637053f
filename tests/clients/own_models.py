"""Models of one's own that tests give to a simulation, or start as programs of a run.

    own_models.py MODEL
"""
import json
import math
import sys

import numpy as np

import dmise

A, RATE, TILT = 7_178_137.0, 1.0381e-3, math.radians(98.6)


def state_at(t_s, **more):
    u = math.radians(0.15) + RATE * t_s
    along = lambda c, s: [A * c, A * s * math.cos(TILT), A * s * math.sin(TILT)]
    return dmise.State(along(math.cos(u), math.sin(u)), [RATE * x for x in along(-math.sin(u), math.cos(u))], **more)


@dmise.actor("probe")
def orbit(t_s, world, options):
    return state_at(t_s, albedo=options.get("albedo"))


@dmise.actor("probe")
class Walk:
    """Remembers where it was, and that nobody else has called it."""
    def __init__(self):
        self.calls, self.drift_m, self.drift_m_per_s = 0, np.zeros(3), np.zeros(3)

    def __call__(self, t_s, world, options):
        assert self.calls == world.tick, (self.calls, world.tick)
        if self.calls > 0:
            acceleration = np.array([0.5, -0.3, 0.1]) * self.calls
            self.drift_m += self.drift_m_per_s + 0.5 * acceleration
            self.drift_m_per_s += acceleration
        self.calls += 1
        state = state_at(t_s)
        return dmise.State(state.position_m + self.drift_m, state.velocity_m_per_s + self.drift_m_per_s)


@dmise.actor()
def tumble(t_s, world, options):
    angle = options["rate_rad_per_s"] * t_s
    return dmise.State(gcrs_from_body=[math.cos(angle / 2), 0, 0, math.sin(angle / 2)], rate_rad_per_s=[0, 0, options["rate_rad_per_s"]])


@dmise.actor("probe")
class Tells:
    """Writes what it is told."""
    def __call__(self, t_s, world, options):
        with open(options["told"], "a") as file:
            told = [t_s, world.tick, world.time_ns, world.node, world.objects, world.seed, str(world.time_utc), options,
                    world.environment.sun_m.tolist(), repr(world.environment.earth), len(world.messages)]
            file.write(json.dumps(told) + chr(10))
        return state_at(t_s)


@dmise.actor("probe")
class Wrong:
    def __call__(self, t_s, world, options):
        state = state_at(t_s)
        if world.tick == 3:
            match options["fault"]:
                case "nan": state.position_m[1] = math.nan
                case "shape": state.position_m = state.position_m[:2]
                case "far": state.position_m[1] = 1e16
                case "fast": state.velocity_m_per_s[0] = 3e8
                case "nothing": return dmise.State()
                case "text": return "here"
                case "ghost": return {"ghost": state}
                case "two": return [state, state]
                case "albedo": state.albedo = -2.0
                case "words": state.position_m = ["a", "b", "c"]
                case "attitude": state.gcrs_from_body = [0, 0]
        return state


@dmise.detector
def peaks(frame, options):
    light_e = (frame.counts - np.median(frame.counts)) * frame.gain_e_per_dn
    y, x = (int(i) for i in np.unravel_index(np.argmax(light_e), light_e.shape))
    return [dmise.Found(x_px=x, y_px=y, sigma_px=0.3, flux_e=light_e[y, x], snr=9.0 + options["step"])]


@dmise.detector
class Counts:
    """Says by its SNR which of its frames it is."""
    def __init__(self):
        self.frames = []

    def __call__(self, frame, options):
        self.frames.append(frame)
        assert {f.sensor for f in self.frames} == {frame.sensor} and frame.number == len(self.frames), frame
        return dmise.Found(x_px=np.arange(2.0) + 50, y_px=np.arange(2.0) + 40, sigma_px=0.4, flux_e=5000.0,
                           snr=10.0 * len(self.frames) + frame.exposure_s)


@dmise.detector
def wrong_find(frame, options):
    found = dmise.Found(x_px=10, y_px=10, sigma_px=0.3, flux_e=5000, snr=9)
    if frame.number == 2:
        match options["fault"]:
            case "nan": found.x_px = math.nan
            case "outside": found.x_px = 4000
            case "sigma": found.sigma_px = None
            case "type": return 5
    return [found]


if __name__ == "__main__":
    dmise.serve(globals()[sys.argv[1]])
