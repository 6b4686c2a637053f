#include "core/base/numeric/golden_section.h"

#include <gtest/gtest.h>

#include <cmath>

namespace dmise {
namespace {

TEST(GoldenSection, FindsTheLeastInTheMiddleAndAtBothEnds) {
  for (const double least : {-3.0, -1.2345, 0.0, 2.0}) {
    int looks = 0;
    const auto of = [&](double x) {
      ++looks;
      return 5.0 + std::abs(x - least);
    };
    const Least found = golden_section(of, -3.0, 2.0, 1e-6);
    EXPECT_NEAR(found.at, least, 1e-6);
    EXPECT_NEAR(found.value, 5.0, 2e-6);
    // Each look leaves 0.618 of the range.
    EXPECT_LE(looks, 3 + int(std::log(5.0 / 1e-6) / std::log(1.618)));
  }
}

TEST(GoldenSection, ARangeThatIsNarrowEnoughIsItsMiddle) {
  EXPECT_EQ(golden_section([](double x) { return x * x; }, 1.0, 1.5, 1.0).at, 1.25);
}

}  // namespace
}  // namespace dmise
