#pragma once
#include "core/products/observation.h"

namespace dmise {

/// Keywords of an observation, listed once for writing and reading.
template <class Visitor>
void visit_observation(Visitor& v, Observation& o) {
  v.optional_text("OBJECT", o.object, "what is pointed at");
  v.optional_text("TELESCOP", o.telescope, "camera and telescope");
  v.optional_number("MJD-OBS", o.start_mjd, "[d] UTC, start of the exposure");
  v.optional_angle("RA", o.ra_rad, "[deg] of the centre, ICRS, mid exposure");
  v.optional_angle("DEC", o.dec_rad, "[deg] of the centre, ICRS, mid exposure");
  v.optional_number("AIRMASS", o.airmass, "of the centre, mid exposure");
  v.optional_angle("SUNALT", o.sun_altitude_rad, "[deg] altitude of the Sun, mid exposure");
  v.optional_angle("MOONALT", o.moon_altitude_rad, "[deg] altitude of the Moon, mid exposure");
}

}  // namespace dmise
