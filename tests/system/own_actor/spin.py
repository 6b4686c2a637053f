"""Turns an object about its z axis; whoever moves it is another."""
import math

import dmise


@dmise.actor("probe")
def spin(t_s, world, options):
    rate = options["rate_rpm"] * 2 * math.pi / 60
    angle = math.remainder(rate * t_s, 2 * math.pi)
    return dmise.State(gcrs_from_body=[math.cos(angle / 2), 0, 0, math.sin(angle / 2)], rate_rad_per_s=[0, 0, rate])


dmise.serve(spin)
