#include <gtest/gtest.h>

#include <array>

#include "core/projection/first_root.h"

namespace dmise {
namespace {

// By hand, from the factors.
TEST(FirstRoot, IsTheLeastOfAPolynomial) {
  EXPECT_FALSE(first_root(std::array{1.0}, 10));
  EXPECT_FALSE(first_root(std::array{1.0, 2.0, 3.0}, 1e9));
  EXPECT_FALSE(first_root(std::array{1.0, -0.05}, 10));
  EXPECT_NEAR(*first_root(std::array{1.0, -0.05}, 1e9), 20, 1e-12);
  EXPECT_NEAR(*first_root(std::array{6.0, -11.0, 6.0, -1.0}, 1e9), 1, 1e-12);     // 1, 2, 3
  EXPECT_NEAR(*first_root(std::array{6.0, -5.0, 1.0, 0.0, 0.0}, 1e9), 2, 1e-12);  // 2, 3
  EXPECT_NEAR(*first_root(std::array{4.0, 0.0, -5.0, 0.0, 1.0}, 1e9), 1, 1e-12);  // +-1, +-2
  EXPECT_NEAR(*first_root(std::array{4.0, -4.0, 1.0}, 1e9), 2, 1e-7);             // touches at 2
}

}  // namespace
}  // namespace dmise
