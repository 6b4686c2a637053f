"""A sensor of one's own: a station that measures directions and ranges of satellites by laser, day and night. ranging.yaml starts
it and tells it the truth; docs/howto/plug-in-a-model.md explains it."""
import dmise
import numpy as np

LIGHT_M_PER_S = 299792458.0


@dmise.sensor
def station(exposure, world, options):
    truth = world.truth  # states of all objects: arrays 3 x n
    line_m = truth.position_m - exposure.position_m[:, None]
    line_m = line_m - truth.velocity_m_per_s * (np.linalg.norm(line_m, axis=0) / LIGHT_M_PER_S)  # when the light left them
    range_m = np.linalg.norm(line_m, axis=0)
    towards = line_m / np.maximum(range_m, 1.0)
    up = exposure.position_m / np.linalg.norm(exposure.position_m)
    seen = (truth.code == 0) & (range_m < options["farthest_m"]) & \
        (up @ towards > np.sin(np.radians(options["least_elevation_deg"])))
    towards, range_m, velocity = towards[:, seen], range_m[seen], truth.velocity_m_per_s[:, seen]
    rate = np.sum(towards * (velocity - exposure.velocity_m_per_s[:, None]), axis=0)
    rate = rate / (1 + np.sum(towards * velocity, axis=0) / LIGHT_M_PER_S)
    sigma_rad = np.radians(options["sigma_arcsec"] / 3600)
    noise = np.random.default_rng([world.seed, exposure.frame])  # the same in each run
    n = len(range_m)
    return dmise.Sighting(direction=towards + sigma_rad * noise.standard_normal((3, n)), sigma_rad=sigma_rad,
                          range_m=range_m + options["sigma_m"] * noise.standard_normal(n), range_sigma_m=options["sigma_m"],
                          range_rate_m_per_s=rate + options["sigma_m_per_s"] * noise.standard_normal(n),
                          range_rate_sigma_m_per_s=options["sigma_m_per_s"])


if __name__ == "__main__":
    dmise.serve(station)
