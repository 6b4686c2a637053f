#include "core/photometry/band_parts.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/units.h"
#include "core/photometry/star_light.h"

namespace dmise {
namespace {

// Photons add: what passes the parts is what passes the band.
TEST(BandParts, SumToTheBand) {
  for (const Band& band : {Band{"top hat", 0.6 * um, 0.4 * um, {}}, *filter_named("bessell-V"),
                           *filter_named("sdss-r")})
    for (const int count : {1, 2, 5, 16}) {
      const auto parts = parts_of(band, count);
      ASSERT_EQ(parts.size(), std::size_t(count));
      EXPECT_NEAR(parts.front().low_m(), band.low_m(), 1e-15);
      EXPECT_NEAR(parts.back().high_m(), band.high_m(), 1e-15);
      double sum = 0;
      for (const Band& part : parts) sum += StarLight(part).photons_per_s_m2(5, 0.65);
      EXPECT_NEAR(sum / StarLight(band).photons_per_s_m2(5, 0.65), 1.0, 1e-3) << band.name;
    }
}

TEST(BandParts, APartWithoutLightIsLeftOut) {
  const Band gap =
      band_of("gap", {{0.4 * um, 0.5 * um, 0.6 * um, 0.7 * um, 0.8 * um}, {1, 0, 0, 0, 1}});
  EXPECT_EQ(parts_of(gap, 4).size(), 2u);
}

}  // namespace
}  // namespace dmise
