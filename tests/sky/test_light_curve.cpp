#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/sky/variables/light_curve.h"

namespace dmise {
namespace {

/// Magnitudes below the maximum at phases 0, 0.02 .. 0.5.
using HalfCurve = std::array<double, 26>;

struct Difference {
  double rms_mag = 0.0, greatest_mag = 0.0;
};

Difference between(const StarLightCurve& curve, const HalfCurve& reference) {
  Difference d;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const double off = curve.fainter_by_mag(0.02 * double(i)) - reference[i];
    d.rms_mag += off * off / double(reference.size());
    d.greatest_mag = std::max(d.greatest_mag, std::abs(off));
  }
  d.rms_mag = std::sqrt(d.rms_mag);
  return d;
}

// Reference: PHOEBE 2.5.4, tests/reference/variable_stars.py --phoebe. The curve has the two depths
// of each; between them it must be right without being told more.
TEST(LightCurve, OfStarsThatTouchAgreesWithRocheModels) {
  const HalfCurve contact = {0.712, 0.668, 0.533, 0.400, 0.292, 0.209, 0.149, 0.105, 0.071,
                             0.043, 0.021, 0.006, 0.000, 0.001, 0.011, 0.026, 0.049, 0.076,
                             0.106, 0.145, 0.201, 0.278, 0.379, 0.495, 0.595, 0.610};
  const HalfCurve grazing = {0.355, 0.340, 0.301, 0.251, 0.199, 0.154, 0.116, 0.085, 0.058,
                             0.035, 0.017, 0.005, 0.000, 0.001, 0.009, 0.022, 0.041, 0.063,
                             0.088, 0.115, 0.147, 0.186, 0.230, 0.274, 0.307, 0.320};
  const HalfCurve hot = {0.850, 0.745, 0.544, 0.361, 0.224, 0.133, 0.083, 0.062, 0.043,
                         0.026, 0.013, 0.004, 0.000, 0.001, 0.006, 0.016, 0.030, 0.047,
                         0.067, 0.087, 0.113, 0.148, 0.195, 0.251, 0.304, 0.329};
  const HalfCurve cool = {0.637, 0.557, 0.389, 0.228, 0.114, 0.053, 0.041, 0.031, 0.022,
                          0.013, 0.007, 0.002, 0.000, 0.000, 0.003, 0.008, 0.015, 0.024,
                          0.033, 0.043, 0.053, 0.067, 0.085, 0.107, 0.126, 0.133};
  for (const HalfCurve& reference : {contact, grazing, hot, cool}) {
    const StarLightCurve curve{.shape = LightCurveShape::touching_eclipses,
                               .depth_mag = reference.front(),
                               .second_depth_mag = reference.back()};
    const Difference d = between(curve, reference);
    EXPECT_LT(d.rms_mag, 0.025) << reference.front();
    EXPECT_LT(d.greatest_mag, 0.06) << reference.front();
  }
}

// Reference: PHOEBE with the stars of Baron et al. 2012, ApJ 752, 20.
TEST(LightCurve, OfAlgolAgreesWithItsOrbitAndRadii) {
  const HalfCurve algol = {1.247, 0.873, 0.368, 0.077, 0.015, 0.013, 0.011, 0.009, 0.006,
                           0.004, 0.002, 0.001, 0.000, 0.000, 0.001, 0.002, 0.004, 0.006,
                           0.009, 0.012, 0.015, 0.018, 0.021, 0.029, 0.037, 0.041};
  const StarLightCurve curve{.shape = LightCurveShape::separate_eclipses,
                             .depth_mag = 1.247,
                             .second_depth_mag = 0.041,
                             .share = 0.14};
  const Difference d = between(curve, algol);
  EXPECT_LT(d.rms_mag, 0.03);
  EXPECT_LT(d.greatest_mag, 0.09);  // on the steepest part: 4 minutes
}

// Reference: delta Cephei by the AAVSO's observations, arXiv:2606.29543: the share of the rise is
// 0.2885, its mean 0.4230 of the way up from there.
TEST(LightCurve, OfACepheidRisesAsDeltaCephei) {
  const StarLightCurve curve{
      .shape = LightCurveShape::cepheid, .depth_mag = 0.8544, .share = 0.2885};
  double faintest = 0.0, at = 0.0;
  for (int i = 0; i < 10000; ++i)
    if (const double m = curve.fainter_by_mag(i / 10000.0); m > faintest)
      faintest = m, at = i / 10000.0;
  EXPECT_NEAR(faintest, 0.8544, 1e-5);
  EXPECT_NEAR(1.0 - at, 0.2885, 2e-4);
  // A0 = 3.9031, the brightest is A0 less 0.4699: the series' own mean.
  EXPECT_NEAR(curve.mean_fainter_by_mag(), 0.4699, 1e-3);
}

// Every pulsation is at its brightest at phase 0, at its faintest a rise before, and nowhere
// beyond.
TEST(LightCurve, KeepsWithinItsRange) {
  using enum LightCurveShape;
  for (const auto shape : {cepheid, rr_lyrae, even})
    for (const double share : {0.05, 0.16, 0.3, 0.5, 0.7}) {
      const StarLightCurve curve{.shape = shape, .depth_mag = 2.0, .share = share};
      EXPECT_NEAR(curve.fainter_by_mag(0.0), 0.0, 1e-6);
      EXPECT_NEAR(curve.fainter_by_mag(1.0 - share), 2.0, 1e-6);
      for (int i = 0; i < 1000; ++i) {
        EXPECT_GE(curve.fainter_by_mag(i / 1000.0), -1e-6);
        EXPECT_LE(curve.fainter_by_mag(i / 1000.0), 2.0 + 1e-6);
      }
      EXPECT_NEAR(curve.fainter_by_mag(0.9999999), 0.0, 1e-4);
    }
  const StarLightCurve eclipses{
      .shape = separate_eclipses, .depth_mag = 1.0, .second_depth_mag = 0.3, .share = 0.1};
  EXPECT_EQ(eclipses.fainter_by_mag(0.0), 1.0);
  EXPECT_EQ(eclipses.fainter_by_mag(0.5), 0.3);
  EXPECT_EQ(eclipses.fainter_by_mag(0.051), 0.0);
  EXPECT_EQ(eclipses.fainter_by_mag(0.25), 0.0);
}

TEST(LightCurve, IsByTheMainTypeOfTheCatalogue) {
  using enum LightCurveShape;
  EXPECT_EQ(light_curve_kind("EA/SD").shape, separate_eclipses);
  EXPECT_EQ(light_curve_kind("EW/KW").shape, touching_eclipses);
  EXPECT_EQ(light_curve_kind("EB:").shape, touching_eclipses);
  EXPECT_EQ(light_curve_kind("DCEP(B)").shape, cepheid);
  EXPECT_EQ(light_curve_kind("DCEPS").shape, even);
  EXPECT_EQ(light_curve_kind("RRAB/BL").shape, rr_lyrae);
  EXPECT_EQ(light_curve_kind("M").shape, even);
  EXPECT_EQ(light_curve_kind("SRB").shape, even);
  for (const char* type : {"LB", "ZAND", "NA", "ELL+BCEP", "DSCT", "", "MM", "EAX"})
    EXPECT_EQ(light_curve_kind(type).shape, constant) << type;
}

TEST(LightCurve, CountsPeriodsFromItsEpochBothWays) {
  const StarLightCurve curve{.epoch_hjd = 2450000.0, .period_d = 4.0};
  EXPECT_NEAR(curve.phase(2450001.0), 0.25, 1e-12);
  EXPECT_NEAR(curve.phase(2449999.0), 0.75, 1e-12);
  EXPECT_NEAR(curve.phase(2451002.0), 0.5, 1e-12);
  EXPECT_LT(curve.phase(2450000.0 - 1e-14), 1.0);
}

}  // namespace
}  // namespace dmise
