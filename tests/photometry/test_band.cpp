#include "core/photometry/band.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/units.h"

namespace dmise {
namespace {

// Mean wavelengths as the SVO Filter Profile Service lists them (Generic/Bessell, SLOAN/SDSS).
TEST(Band, FiltersLieWhereTheyShould) {
  const double expected_nm[] = {360.5, 441.3, 551.2, 658.6, 806.0,
                                357.2, 475.1, 620.4, 751.9, 899.2};
  const auto names = filter_names();
  ASSERT_EQ(names.size(), 10u);
  for (std::size_t i = 0; i < names.size(); ++i)
    EXPECT_NEAR(filter_named(names[i])->centre_m, expected_nm[i] * nm, 8 * nm) << names[i];
  EXPECT_FALSE(filter_named("johnson-Q"));
}

TEST(Band, GlassInFrontMultiplies) {
  const Band clear{"clear", 0.55 * um, 0.1 * um, {}};
  const Band grey = through(clear, {{0.4 * um, 0.7 * um}, {0.5, 0.5}});
  EXPECT_NEAR(grey.centre_m, 0.55 * um, 1e-12);
  EXPECT_NEAR(grey.width_m, 0.1 * um, 1e-12);
  EXPECT_NEAR(grey.response.at_or_zero(0.52 * um), 0.5, 1e-12);
  EXPECT_EQ(grey.response.at_or_zero(0.61 * um), 0.0);
  // Ramp times ramp: integral of (x/w)^2 is w/3.
  const Band ramp = band_of("ramp", {{0.5 * um, 0.6 * um}, {0, 1}});
  const Band both = through(ramp, {{0.5 * um, 0.6 * um}, {0, 1}});
  EXPECT_NEAR(both.width_m, 0.1 * um / 3, 1e-3 * 0.1 * um / 3);
}

TEST(Band, NonsenseIsRefused) {
  EXPECT_THROW(band_of("x", {{0.5 * um, 0.4 * um}, {1, 1}}), Error);
  EXPECT_THROW(band_of("x", {{0.4 * um, 0.5 * um}, {1, 1.5}}), Error);
  EXPECT_THROW(band_of("x", {{0.4 * um, 0.5 * um}, {0, 0}}), Error);
  EXPECT_THROW(band_of("x", {{0.4 * um, 0.5 * um}, {0}}), Error);
  EXPECT_THROW(check_band({"x", 0.5 * um, 0.0, {}}), Error);
  EXPECT_THROW(check_band({"x", 0.1 * um, 0.3 * um, {}}), Error);
}

}  // namespace
}  // namespace dmise
