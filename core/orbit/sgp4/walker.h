#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/orbit/elements/elements.h"
#include "core/time/julian_date.h"

namespace dmise {

inline constexpr int max_walker_satellites = 100'000;

/// A constellation of circular orbits in the notation i: T/P/F of Walker 1984 ("Satellite
/// constellations", J. Brit. Interplanet. Soc. 37, 559): T satellites in P planes whose nodes are
/// equally spaced over `raan_spread_rad`. A satellite is F * 360 deg / T farther from its node than
/// the one at its place in the plane to the west. Or a train, as after a launch: of one plane, each
/// satellite passes a latitude `spacing_s` after the one before.
struct Walker {
  std::string name;                // satellites are NAME-PLANE-PLACE, of a train NAME-PLACE, from 1
  std::uint32_t first_number = 0;  // catalogue number of the first
  int planes = 1;
  int per_plane = 1;
  int phasing = 0;                        // F, [0, planes)
  double semi_major_axis_m = 0.0;         // mean, see `kozai_mean_motion_rad_per_min`
  double inclination_rad = 0.0;           // [0, pi]
  double raan_spread_rad = 0.0;           // 2 pi: delta; pi: star
  double raan_rad = 0.0;                  // the first plane's, in TEME of the epoch
  double argument_of_latitude_rad = 0.0;  // the first satellite's
  double spacing_s = 0.0;  // > 0: a train, below; 0: places are spread over the plane
  Utc epoch;

  int satellites() const { return planes * per_plane; }
  bool operator==(const Walker&) const = default;
};

/// Element sets of the satellites for SGP4, without drag: plane by plane, each from its first
/// place.
std::vector<MeanElements> elements_of(const Walker& walker);

/// The mean motion of an element set whose orbit has this semi-major axis in SGP4, after Kozai's
/// mean motion is converted to Brouwer's; of a circular orbit.
double kozai_mean_motion_rad_per_min(double semi_major_axis_m, double inclination_rad);

}  // namespace dmise
