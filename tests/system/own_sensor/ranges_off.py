"""The station of the examples, which says directions alone."""
import dataclasses

import dmise
import ranging


@dmise.sensor
def station(exposure, world, options):
    return dataclasses.replace(ranging.station(exposure, world, options), range_m=None, range_rate_m_per_s=None)


dmise.serve(station)
