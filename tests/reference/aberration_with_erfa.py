"""Prints tests/reference/aberration_values.inc: directions, velocities [m/s] and eraAb's directions."""

import erfa
import numpy as np

LIGHT = 299792458.0
for from_, velocity in [((0.3, -0.5, 0.7), (2.0e4, -1.5e4, -7.0e3)), ((1, 0, 0), (3.0e4, 0, 0)),
                        ((-0.8, 0.1, 0.2), (-2.6e4, -1.35e4, -5.85e3)), ((0, 0, -1), (4e3, -5e3, 3e4))]:
    p = np.array(from_) / np.linalg.norm(from_)
    v = np.array(velocity) / LIGHT
    seen = erfa.ab(p, v, 1e30, np.sqrt(1 - v @ v))
    print("{" + ", ".join("{" + ", ".join(repr(float(c)) for c in x) + "}"
                          for x in (p, velocity, seen)) + "},")
