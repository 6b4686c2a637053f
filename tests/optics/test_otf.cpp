#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"
#include "core/optics/waves/otf.h"

namespace dmise {
namespace {

constexpr double lambda = 0.55e-6, diameter = 0.3;
constexpr double cutoff = diameter / lambda;

// Reference: the closed form at a half and a quarter of the cut-off.
TEST(Otf, OfAClearApertureIsTheOverlapOfTwoDiscs) {
  EXPECT_DOUBLE_EQ(diffraction_otf(0, lambda, diameter), 1.0);
  EXPECT_NEAR(diffraction_otf(cutoff / 2, lambda, diameter), 2.0 / 3 - std::sqrt(3) / (2 * pi),
              1e-14);
  EXPECT_NEAR(diffraction_otf(cutoff / 4, lambda, diameter), 0.68504, 1e-5);
}

TEST(Otf, IsWithinZeroAndOneAlsoAtAndBeyondTheCutOffAndForAnyObscuration) {
  for (double e : {0.0, 0.01, 0.3, 0.7, 0.99})
    for (double x = 0; x < 2.0; x += 0.001) {
      const double h = diffraction_otf(x * cutoff, lambda, diameter, e);
      ASSERT_GE(h, 0.0);
      ASSERT_LE(h, 1.0);
      ASSERT_TRUE(x < 1.0 || h == 0.0);
    }
  EXPECT_EQ(diffraction_otf(std::nextafter(cutoff, 2 * cutoff), lambda, diameter), 0.0);
  EXPECT_EQ(diffraction_otf(1e6, 0.0, diameter), 1.0);   // no wavelength, no diffraction
  EXPECT_EQ(diffraction_otf(1.0, lambda, 1e-300), 0.0);  // no aperture, no image
}

// Reference: the overlap of two annuli counted on a grid.
TEST(Otf, OfAnObscuredApertureIsTheOverlapOfTwoAnnuli) {
  const double e = 0.45;
  const int n = 1500;
  const auto open = [&](double x, double y) {
    const double r = std::hypot(x, y);
    return r <= 0.5 && r >= 0.5 * e;
  };
  for (double shift : {0.05, 0.2, 0.4, 0.5, 0.7, 0.9}) {
    long both = 0, one = 0;
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const double x = (i + 0.5) / n - 0.5, y = (j + 0.5) / n - 0.5;
        if (!open(x, y)) continue;
        ++one;
        both += open(x + shift, y);
      }
    EXPECT_NEAR(diffraction_otf(shift * cutoff, lambda, diameter, e), double(both) / double(one),
                5e-4);
  }
}

TEST(Otf, OfALongExposureFallsAsFriedSays) {
  EXPECT_NEAR(long_exposure_otf(0.1 / lambda, lambda, 0.1), std::exp(-3.44), 1e-12);
  EXPECT_EQ(long_exposure_otf(1e5, lambda, std::numeric_limits<double>::infinity()), 1.0);
  EXPECT_GE(long_exposure_otf(1e7, lambda, 1e-3), 0.0);
}

TEST(Otf, OfAPixelIsOneAtZeroAndNothingAtOneCycleAPixel) {
  EXPECT_EQ(pixel_otf(0.0, 1e-5), 1.0);
  EXPECT_NEAR(pixel_otf(1e5, 1e-5), 0.0, 1e-15);
  EXPECT_NEAR(pixel_otf(5e4, 1e-5), 2 / pi, 1e-12);
  EXPECT_NEAR(defocus_otf(0.0, 1e-5), 1.0, 0);
  EXPECT_NEAR(defocus_otf(3.8317059702 / pi / 1e-5, 1e-5), 0.0, 1e-9);  // first zero of J1
}

}  // namespace
}  // namespace dmise
