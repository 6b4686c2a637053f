#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "tests/orbit/sgp4_orbits.h"
#include "tests/support/simd.h"

namespace dmise {
namespace {

using namespace test;

TEST(Sgp4Batch, InstructionSetsAgreeTo1e8Km) {
  const std::vector<MeanElements> elements = mixture(2000);
  const Outputs best = at(Sgp4Batch(elements), epoch_jd1, 6.5);
  for (SimdLevel simd : test::simd_here()) {
    const Outputs other = at(Sgp4Batch(elements, nullptr, simd), epoch_jd1, 6.5);
    EXPECT_EQ(best.code, other.code);
    double worst_m = 0.0;
    for (std::size_t k = 0; k < best.position.size(); ++k)
      worst_m = std::max(worst_m, std::fabs(best.position[k] - other.position[k]));
    EXPECT_LE(worst_m, 1e-5);
  }
}

// One double of days holds 40 us; two tell a microsecond, 7.6 mm in low orbit.
TEST(Sgp4Batch, TellsAMicrosecond) {
  const Sgp4Batch batch(std::vector<MeanElements>{elements_with(0.001, 51.6, 15.5, 1e-5)});
  const double us = 1e-6 / 86400.0;
  EXPECT_NEAR(batch.minutes_since_epoch(0, epoch_jd1, 0.75 + us) * 60e6, 1.0, 1e-3);
  const Outputs a = at(batch, epoch_jd1, 0.75), b = at(batch, epoch_jd1, 0.75 + us);
  const double moved_m = std::hypot(a.position[0] - b.position[0], a.position[1] - b.position[1],
                                    a.position[2] - b.position[2]);
  EXPECT_NEAR(moved_m, 7.65e-3, 0.1e-3);
}

TEST(Sgp4Batch, RefusesOutputOfTheWrongSize) {
  const Sgp4Batch batch(mixture(5));
  Outputs out(4);
  EXPECT_THROW(batch.propagate(epoch_jd1, 0.0, out.position, out.velocity, out.code), Error);
}

TEST(Sgp4Batch, OfNothingIsNothing) {
  const Sgp4Batch batch(std::vector<MeanElements>{});
  EXPECT_EQ(at(batch, epoch_jd1, 0.0).code.size(), 0u);
}

}  // namespace
}  // namespace dmise
