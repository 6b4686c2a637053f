// Prints where a satellite is, in TEME, a day after the epoch of its element set: example LINE1
// LINE2
#include <array>
#include <cstdio>

#include "core/config/schema.h"
#include "core/orbit/elements/tle.h"
#include "core/orbit/sgp4/sgp4_batch.h"
#include "core/sky/places/sun_moon.h"

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const std::array elements{dmise::parse_tle(argv[1], argv[2])};
  constexpr double minutes_a_day = 1440.0;
  const auto state = dmise::Sgp4Batch(elements).propagate_one(0, minutes_a_day);
  if (state.code != dmise::Sgp4Code::ok) return 1;
  const auto& p = state.position_m;
  std::printf("%.12f %.12f %.12f km; %zu kinds of files, ephemeris from %d\n", p.x / 1e3, p.y / 1e3,
              p.z / 1e3, dmise::file_kinds().size(), dmise::ephemeris_first_year);
}
