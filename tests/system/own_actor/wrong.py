"""An actor that does something wrong at a tick, 3 if none is told."""
import math
import os
import signal
import threading

import dmise


@dmise.actor("probe")
def orbit(t_s, world, options):
    place, speed = [7178112.0, -2810.0, 18581.0 + 7368.0 * t_s], [0.0, 0.0, 7368.0]
    fault = options["fault"] if world.tick == options.get("at", 3) else ""
    if fault == "raises":
        raise ValueError("no fuel")
    if fault == "exits":
        os._exit(7)
    if fault == "wrong_shape":
        place = place[:2]
    if fault == "nan":
        place[1] = math.nan
    if fault == "far":
        place[1] = 1e16
    if fault == "fast":
        speed[0] = 3e8
    if fault == "nothing":
        return dmise.State()
    if fault == "no_return":
        return None
    if fault == "kilometres":
        place = [x / 1000 for x in place]
    if fault == "another_object":
        return {"ghost": dmise.State(place, speed)}
    if fault == "killed":
        os.kill(os.getpid(), signal.SIGKILL)
    if fault == "killed_between_ticks":  # which are 100 ms apart
        threading.Timer(0.02, os.kill, (os.getpid(), signal.SIGKILL)).start()
    if fault == "stopped":
        os.kill(os.getpid(), signal.SIGSTOP)
    return dmise.State(position_m=place, velocity_m_per_s=speed)


dmise.serve(orbit)
