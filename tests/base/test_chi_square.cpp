#include "core/base/numeric/chi_square.h"

#include <gtest/gtest.h>

namespace dmise {
namespace {

// Reference: scipy 1.10.1, chi2.isf(norm.sf(z), degrees).
TEST(ChiSquare, AgreesWithScipy) {
  constexpr struct {
    double degrees, z, chi2;
  } cases[] = {{2, 0, 1.386294361119891},       {2, 3.0902, 13.81529300338306},
               {6, -2, 1.192574980118936},      {6, 0, 5.348120627447118},
               {6, 3.0902, 22.457484729989403}, {20, -2, 9.438467437241508},
               {20, 3.0902, 45.31439954712166}, {200, -2, 162.03177068678386},
               {200, 3.0902, 267.5397450024699}};
  for (const auto& c : cases) {
    const double tolerance = c.z <= 3 ? 0.1 : c.degrees < 6 ? 0.03 : 0.01;  // the far tail decides
    EXPECT_NEAR(chi_square_of_normal(c.z, c.degrees), c.chi2, tolerance * c.chi2) << c.degrees;
    EXPECT_NEAR(normal_of_chi_square(chi_square_of_normal(c.z, c.degrees), c.degrees), c.z, 1e-9);
  }
}

}  // namespace
}  // namespace dmise
