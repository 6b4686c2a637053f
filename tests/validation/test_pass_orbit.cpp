#include "bench/validation/pass_orbit.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/units.h"

namespace dmise {
namespace {

constexpr double inclination_rad = 87.9 * deg;

/// Ranges and phases of a minute of a pass over a site that stands still.
std::vector<RangePhase> seen(const CircularPass& pass, const Vec<Cirs>& to_sun,
                             const Vec<Cirs>& site_m) {
  std::vector<RangePhase> all;
  for (double t = -30.0; t <= 30.0; t += 5.0) {
    const Vec<Cirs> line = site_m - pass.at(t).position_m;
    all.push_back({t, norm(line), angle_rad(line, to_sun), site_m});
  }
  return all;
}

// What made the ranges and phases comes back, northwards and southwards, on both sides of the Sun.
TEST(PassOrbit, FindsTheOrbitOfAPass) {
  const Vec<Cirs> site_m = from_spherical<Cirs>(1.0, 43.65 * deg) * 6.370e6;
  const Vec<Cirs> to_sun = from_spherical<Cirs>(1.0 + 105.0 * deg, -20.0 * deg);
  for (const double argument_deg : {40.0, 47.0, 133.0, 141.0})
    for (const double beside_deg : {-8.0, 7.0}) {
      const bool southwards = argument_deg > 90.0;
      const CircularPass pass{.inclination_rad = inclination_rad,
                              .raan_rad = 1.0 + (southwards ? pi : 0.0) + beside_deg * deg,
                              .argument_rad = argument_deg * deg,
                              .radius_m = 7.590e6};
      const CircularPass found =
          fit_circular_pass(seen(pass, to_sun, site_m), to_sun, inclination_rad, 1200e3);
      EXPECT_LT(found.rms_m, 1.0) << argument_deg << " " << beside_deg;
      EXPECT_LT(norm(found.at(0.0).position_m - pass.at(0.0).position_m), 1e3)
          << argument_deg << " " << beside_deg;
      EXPECT_LT(norm(found.at(0.0).velocity_m_per_s - pass.at(0.0).velocity_m_per_s), 10.0);
    }
}

TEST(PassOrbit, RefusesWhatNoOrbitFits) {
  const Vec<Cirs> site_m{6.37e6, 0.0, 0.0}, to_sun{0.0, 1.0, 0.0};
  std::vector<RangePhase> wild;
  for (double t = 0.0; t < 60.0; t += 10.0)
    wild.push_back({t, 1e6 + 3e5 * (int(t / 10) % 2), 1.0, site_m});
  EXPECT_THROW(fit_circular_pass(wild, to_sun, inclination_rad, 1200e3), Error);
}

}  // namespace
}  // namespace dmise
