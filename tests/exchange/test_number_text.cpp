#include "core/exchange/number_text.h"

#include <gtest/gtest.h>

#include "core/base/error.h"

namespace dmise {
namespace {

TEST(FixedText, HasNoNegativeZeroAndRefusesWhatIsNotFinite) {
  EXPECT_EQ(fixed_text(-1e-12, 3), "0.000");
  EXPECT_EQ(fixed_text(-1.25, 2), "-1.25");
  EXPECT_THROW(fixed_text(0.0 / 0.0, 3), Error);
}

}  // namespace
}  // namespace dmise
