#include "core/exchange/number_text.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "core/base/error.h"

namespace dmise {
namespace {

TEST(FixedText, HasNoNegativeZeroAndRefusesWhatIsNotFinite) {
  EXPECT_EQ(fixed_text(-1e-12, 3), "0.000");
  EXPECT_EQ(fixed_text(-1.25, 2), "-1.25");
  EXPECT_THROW(fixed_text(0.0 / 0.0, 3), Error);
}

TEST(ExactText, ReadsBackToTheSameBits) {
  for (const double value : {0.1, 1.0 / 3.0, 6.02e23, -5e-324, 1.7976931348623157e308})
    EXPECT_EQ(std::strtod(exact_text(value).c_str(), nullptr), value);
  EXPECT_EQ(exact_text(0.1), "0.1");
  EXPECT_THROW(exact_text(1.0 / 0.0), Error);
}

}  // namespace
}  // namespace dmise
