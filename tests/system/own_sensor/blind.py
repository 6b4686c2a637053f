"""A sensor that knows no truth: it sees Sun and Moon, from where it is."""
import dmise


@dmise.sensor
class Blind:
    async def __call__(self, exposure, world, options):
        if world.truth is not None:
            raise ValueError("it is told the truth")
        sun, moon = (body - exposure.position_m for body in (world.environment.sun_m, world.environment.moon_m))
        return dmise.Sightings([dmise.Sighting(direction=moon, sigma_rad=1e-4, time_s=exposure.end_s, snr=50),
                                dmise.Sighting(direction=sun, covariance_rad2=[1e-8, 1e-9, 2e-8], magnitude=-26.7,
                                               magnitude_sigma=0.1, snr=60)], boresight=moon, limiting_magnitude=5)


dmise.serve(Blind)
