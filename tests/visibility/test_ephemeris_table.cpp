#include "core/visibility/ephemeris_table.h"

#include <gtest/gtest.h>

#include "core/time/iso8601.h"

namespace dmise {
namespace {

// Between its hours, and in the first and last, which need not be whole: the ephemerides at the
// instant itself.
TEST(EphemerisTable, SunAndMoonAreWhereTheirEphemeridesHaveThem) {
  const Clock clock(parse_utc("2018-01-21T00:10:00Z"));
  const SimTime end{27LL * 86400 * 1'000'000'000};
  const EphemerisTable sky(clock, {0}, end);
  for (std::int64_t s = 0; s <= 27LL * 86400; s += 1777) {
    const SimTime t{s * 1'000'000'000};
    const Vec<Gcrs> moon = moon_m(clock.tt(t)), sun = solar_system(clock.tt(t)).sun_m;
    EXPECT_LT(norm(sky.moon_m(t) - moon), 10.0) << s;
    EXPECT_LT(norm(sky.sun_m(t) - sun), 1e-7 * norm(sun)) << s;
  }
}

}  // namespace
}  // namespace dmise
