#include "core/effects/frame_effects.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/effects/plan_facts.h"
#include "core/optics/stray_light.h"
#include "core/optics/thermal_optics.h"
#include "core/sky/bodies/earth_disc.h"
#include "core/sky/bodies/limb_airglow.h"
#include "core/sky/bodies/limb_extinction.h"
#include "core/sky/bodies/moon_disc.h"
#include "core/sky/bodies/sun_disc.h"
#include "core/sky/limb_air.h"

namespace dmise {
namespace {

/// A sky of 10 e- of noise and of light that no part has.
PlanFacts plain() {
  PlanFacts f;
  f.columns = f.rows = 256;
  f.read_noise_e = 10.0;
  f.fwhm_px = 2.0;
  f.peak_share = 0.2;
  f.sky.push_back({.sky_e = 1.0, .noise_e = 10.0});
  return f;
}

template <class Effect>
void expect_no_worse_by_rising_level(const PlanFacts& f) {
  for (int level = 1; level < Effect::facts.reference(); ++level) {
    const ErrorBound lower = Effect::error(level - 1, f), here = Effect::error(level, f);
    for (const auto& kind : error_kinds)
      EXPECT_LE(here.*kind.value, lower.*kind.value) << Effect::facts.name << " " << level;
  }
}

TEST(Discs, InTheFieldMustNotBeLeftOutAndHoldWhatDisplacesThem) {
  PlanFacts f = plain();
  for (const auto& error : {SunDisc::error(0, f), MoonDisc::error(0, f), EarthDisc::error(0, f)})
    EXPECT_EQ(error, ErrorBound{});
  EXPECT_EQ(StrayLight::error(0, f), ErrorBound{});
  const double usual = f.shifted_stars(0.1 * f.pixel_rad).background_sigma;
  f.disc_e = 1000.0;
  EXPECT_GE(f.shifted_stars(0.1 * f.pixel_rad).background_sigma, usual + 10.0);
  f.scene.sun_in_field = f.scene.moon_in_field = f.scene.earth_in_field = true;
  for (const auto& error : {SunDisc::error(0, f), MoonDisc::error(0, f), EarthDisc::error(0, f)})
    EXPECT_EQ(error, not_bounded);
  f.stray_light_e = 5.0;
  EXPECT_DOUBLE_EQ(StrayLight::error(0, f).background_sigma, 0.5);
  EXPECT_EQ(MoonDisc::cost_s(0, f), 0.0);
  f.thermal_optics_e = 5.0;
  EXPECT_DOUBLE_EQ(ThermalOptics::error(0, f).background_sigma, 0.5);
}

TEST(Limb, InTheFieldItsLightIsBoundedAndItsExtinctionIsNot) {
  PlanFacts f = plain();
  for (const auto& error :
       {LimbAirglow::error(0, f), LimbAir::error(0, f), LimbExtinction::error(0, f)})
    EXPECT_EQ(error, ErrorBound{});
  EXPECT_EQ(LimbAir::cost_s(1, f), 0.0);
  f.scene.limb_in_field = true;
  f.limb_airglow_e = 5.0;
  f.limb_air_e = 20.0;
  EXPECT_DOUBLE_EQ(LimbAirglow::error(0, f).background_sigma, 0.5);
  EXPECT_DOUBLE_EQ(LimbAir::error(0, f).background_sigma, 2.0);
  EXPECT_EQ(LimbExtinction::error(0, f), not_bounded);
  EXPECT_GT(LimbAir::cost_s(1, f), 0.0);
}

TEST(StarBackground, WithoutStarsInTheFieldTheStarlightThatStandsForThemIsAnError) {
  PlanFacts f = plain();
  EXPECT_EQ(StarBackground::error(0, f), ErrorBound{});
  f.starlight_e[0] = 5.0;
  EXPECT_DOUBLE_EQ(StarBackground::error(0, f).background_sigma, 0.5);
  EXPECT_EQ(StarBackground::error(0, f).photometry_mag, 0.0);
}

TEST(StarBackground, AStarThatCountsMustNotBeLeftOut) {
  PlanFacts f = plain();
  f.brightest_star_e = 0.5 * f.faintest_source_e();
  EXPECT_LT(StarBackground::error(0, f).photometry_mag, 0.01);
  f.brightest_star_e = 1.01 * f.faintest_source_e();
  EXPECT_EQ(StarBackground::error(0, f).photometry_mag, unbounded);
  EXPECT_GT(StarBackground::error(0, f).background_sigma, 1.0);
}

TEST(StarBackground, CostsItsSearchAndItsStars) {
  PlanFacts f = plain();
  f.stars = 1000.0;
  f.stars_brighter[6] = 10.0;
  EXPECT_EQ(StarBackground::cost_s(0, f), 0.0);
  const int to_v6 = 7;
  ASSERT_EQ(StarBackground::limit_v_mag(to_v6), 6.0);
  EXPECT_GT(StarBackground::cost_s(to_v6, f), 0.0);
  EXPECT_GT(StarBackground::cost_s(StarBackground::facts.reference(), f),
            10.0 * StarBackground::cost_s(to_v6, f));
}

TEST(ResolvedShapes, APointIsOffByItsRadiusAtMost) {
  PlanFacts f = plain();
  f.shape_radius_px = {0.3, 0.008};
  for (int level = 0; level < ResolvedShapes::facts.reference(); ++level) {
    const bool is_point = ResolvedShapes::tolerance_px[std::size_t(level)] >= 0.3;
    EXPECT_GE(ResolvedShapes::error(level, f).position_px, is_point ? 0.3 : 0.008) << level;
    EXPECT_LE(ResolvedShapes::error(level, f).position_px, is_point ? 0.35 : 0.01) << level;
    EXPECT_EQ(ResolvedShapes::cost_s(level, f) > 0.0, !is_point) << level;
  }
  expect_no_worse_by_rising_level<ResolvedShapes>(f);
}

/// A star behind a round aperture, without blur but its rings, to 64 of them.
PlanFacts ringed(double star_e) {
  PlanFacts f = plain();
  f.scene.diffracts = true;
  f.relative_bandwidth = 0.25;
  f.airy_px = 2.0;
  f.kernel_end_px = 64.0 * f.airy_px;
  f.kernel_end_share = 0.2 * f.airy_px / (2.0 * std::numbers::pi * std::pow(f.kernel_end_px, 3));
  f.brightest_star_e = star_e;
  return f;
}

/// Share of a point's light a square pixel, `r_px` from it, of the mean of wavelengths of the band.
double airy_share(const PlanFacts& f, double r_px, int wavelengths) {
  double sum = 0.0;
  for (int i = 0; i < wavelengths; ++i) {
    const double wavelength = 1.0 + f.relative_bandwidth * ((i + 0.5) / wavelengths - 0.5);
    const double airy_px = wavelength * f.airy_px, v = std::numbers::pi * r_px / airy_px;
    const double j = 2.0 * std::cyl_bessel_j(1.0, v) / v;
    sum += std::numbers::pi / 4.0 / (airy_px * airy_px) * j * j;
  }
  return sum / wavelengths;
}

TEST(PsfWavelengths, RingsOfAnAiryPatternAreWithinTheBound) {
  for (const double star_e : {1e4, 1e5, 1e6, 1e7}) {
    const PlanFacts f = ringed(star_e);
    for (int level = 0; level < PsfWavelengths::facts.reference(); ++level) {
      const int count = PsfWavelengths::wavelengths(level, f);
      double largest = 0.0;
      for (double r_px = 3.0 * std::hypot(1.0, f.fwhm_px); r_px < f.kernel_end_px; r_px += 0.05) {
        const double reference = f.in_noise(star_e * airy_share(f, r_px, 9));
        const double off = f.in_noise(star_e * airy_share(f, r_px, count)) - reference;
        if (reference < 0.5) largest = std::max(largest, std::abs(off));
      }
      EXPECT_GE(PsfWavelengths::error(level, f).background_sigma, largest)
          << star_e << " " << count;
    }
    expect_no_worse_by_rising_level<PsfWavelengths>(f);
  }
}

TEST(PsfWavelengths, RingsThatStandStillNeedThreeAndSpeckledSourcesTwo) {
  PlanFacts f = ringed(1e7);
  const auto off = [&](int level) { return PsfWavelengths::error(level, f).background_sigma; };
  EXPECT_LT(off(2), 0.6 * off(1));
  f.screens = 100;
  EXPECT_LT(off(1), 0.8 * off(0));
  expect_no_worse_by_rising_level<PsfWavelengths>(f);
}

TEST(PsfWavelengths, ANarrowBandHasNoneToSmearAndACameraMayAskForMore) {
  PlanFacts f = ringed(1e6);
  const double wide = PsfWavelengths::error(2, f).background_sigma;
  f.relative_bandwidth = 0.02;
  EXPECT_LT(PsfWavelengths::error(2, f).background_sigma, 0.2 * wide);
  f.min_wavelengths = 9;
  EXPECT_EQ(PsfWavelengths::error(0, f), ErrorBound{});
  EXPECT_EQ(PsfWavelengths::cost_s(0, f), PsfWavelengths::cost_s(4, f));
}

TEST(PsfWavelengths, FaintSourcesHaveNoRingsInTheNoise) {
  EXPECT_LT(PsfWavelengths::error(0, ringed(100.0)).background_sigma, 0.05);
}

// The centroid of a Gaussian's light by pixels, from far before it to far behind.
TEST(PlanFacts, CentroidsMoveNoFartherThanTheBoundOfAShift) {
  for (const double sigma_px : {0.05, 0.1, 0.2, 0.3, 0.35, 0.45, 0.6, 1.0}) {
    PlanFacts f = plain();
    f.stars = 1.0;
    f.fwhm_px = 2.355 * sigma_px;
    const auto centroid_px = [&](double x_px) {
      double sum = 0.0;
      for (int pixel = -10; pixel <= 10; ++pixel)
        sum += 0.5 * pixel *
               (std::erf((pixel + 0.5 - x_px) / (sigma_px * std::numbers::sqrt2)) -
                std::erf((pixel - 0.5 - x_px) / (sigma_px * std::numbers::sqrt2)));
      return sum;
    };
    for (const double shift_px : {0.01, 0.1, 0.3}) {
      double largest = 0.0;
      for (double x_px = -0.5; x_px < 0.5; x_px += 0.005)
        largest = std::max(largest, centroid_px(x_px + shift_px) - centroid_px(x_px));
      const double bound = f.shifted_stars(shift_px * f.pixel_rad).position_px;
      EXPECT_GE(bound, largest) << sigma_px << ", " << shift_px << " px";
      if (shift_px < 0.02) {
        EXPECT_LE(bound, 1.4 * largest) << sigma_px;
      }
    }
  }
}

// Kernels taper to their end: a source that is shifted shifts that edge, too.
TEST(PlanFacts, TheEndOfAKernelIsNotBelowItsBound) {
  const double pi = std::numbers::pi;
  for (const double end_e : {1.0, 10.0, 40.0, 400.0})
    for (const double shift_px : {0.01, 0.1, 0.4}) {
      PlanFacts f = plain();
      f.stars = 1.0;
      f.kernel_end_px = 8.0;
      f.brightest_star_e = 1e6;
      f.kernel_end_share = end_e / f.brightest_star_e;
      const auto light_e = [&](double r_px) {
        const double from_end_px = std::clamp(f.kernel_end_px - r_px, 0.0, 0.5 * f.kernel_end_px);
        return end_e * std::pow(std::sin(pi * from_end_px / f.kernel_end_px), 2);
      };
      double largest = 0.0;
      for (double r_px = 4.0; r_px < 9.0; r_px += 0.01)
        if (f.in_noise(light_e(r_px)) < 0.5)
          largest = std::max(largest, f.in_noise(light_e(r_px - shift_px) - light_e(r_px)));
      const double bound = f.shifted_stars(shift_px * f.pixel_rad).background_sigma;
      EXPECT_GE(bound, largest) << end_e << " e-, " << shift_px << " px";
    }
}

}  // namespace
}  // namespace dmise
