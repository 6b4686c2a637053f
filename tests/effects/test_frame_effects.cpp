#include "core/effects/frame_effects.h"

#include <gtest/gtest.h>

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

TEST(PsfWavelengths, RingsThatStandStillNeedThreeAndSpeckledSourcesTwo) {
  PlanFacts f = plain();
  f.scene.diffracts = true;
  f.brightest_star_e = 1e7;
  const auto off = [&](int level) { return PsfWavelengths::error(level, f).background_sigma; };
  EXPECT_EQ(off(1), off(0));
  EXPECT_LT(off(2), 0.6 * off(1));
  expect_no_worse_by_rising_level<PsfWavelengths>(f);
  f.screens = 100;
  EXPECT_LT(off(1), 0.8 * off(0));
  expect_no_worse_by_rising_level<PsfWavelengths>(f);
}

TEST(PsfWavelengths, FaintSourcesHaveNoRingsInTheNoise) {
  PlanFacts f = plain();
  f.scene.diffracts = true;
  f.brightest_star_e = 100.0;
  EXPECT_LT(PsfWavelengths::error(0, f).background_sigma, 0.05);
}

}  // namespace
}  // namespace dmise
