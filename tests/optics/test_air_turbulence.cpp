#include "core/optics/waves/air_turbulence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/effects/plan_facts.h"
#include "core/optics/psf_model.h"

namespace dmise {
namespace {

constexpr double lambda = 0.55e-6;

/// The air of an exposure of 32 screens before an aperture of four r0.
AirFacts air() {
  return {.airy_px = 0.5, .apertures_per_r0 = 4.0, .apertures_blown = 8.0, .screens = 32};
}

PlanFacts sees_a_star(double light_e) {
  PlanFacts f;
  f.scene.diffracts = f.scene.turbulent = true;
  f.columns = f.rows = 256;
  f.fwhm_px = 2.0;
  f.peak_share = 0.2;
  f.screens = 32;
  f.air = air();
  f.kernels_change = true;
  f.kernel_s = 0.1;
  f.brightest_star_e = light_e;
  f.sky.push_back({.sky_e = 1.0, .noise_e = 10.0});
  return f;
}

// Reference: tests/reference/turbulence_values.py, the spectrum of a frozen layer's tilt over a
// circular aperture, averaged along the wind and across it. Steps between screens included.
TEST(ImageMotion, FallsWithTheExposureAsAFrozenLayersDoes) {
  struct Row {
    double blown;
    int screens;
    double along, across;  // shares of the variance of an instant
  };
  constexpr Row table[] = {
      {1, 1000, 0.895, 0.959},  {3, 1000, 0.683, 0.836},   {10, 1000, 0.460, 0.632},
      {30, 1000, 0.311, 0.456}, {100, 1000, 0.199, 0.305}, {300, 1000, 0.130, 0.206},
      {2, 2, 0.801, 0.910},     {8, 2, 0.671, 0.762},      {32, 2, 0.602, 0.660},
      {32, 8, 0.345, 0.466},    {100, 32, 0.207, 0.309}};
  AirFacts a = air();
  a.screens = 1;
  const double instant = std::pow(image_motion_px(a), 2.0);
  EXPECT_NEAR(instant, 0.18 * std::pow(4.0, 5.0 / 3.0) * 0.25, 1e-12);
  for (const Row& row : table) {
    a.apertures_blown = row.blown;
    a.screens = row.screens;
    const double share = std::pow(image_motion_px(a), 2.0) / instant;
    // A bound of the mean of both axes, and no more than half above it.
    EXPECT_GE(share * 0.18 / 0.170, 0.5 * (row.along + row.across)) << row.blown;
    EXPECT_LE(share, 1.5 * 0.5 * (row.along + row.across)) << row.blown;
  }
}

// Reference: GalSim 2.8.5, Kolmogorov, light beyond so many FWHM of 0.976 lambda / r0
// (tests/reference/turbulence_values.py).
TEST(ScatteredLight, IsThatOfKolmogorovsLongExposure) {
  struct Row {
    double widths, beyond;
  };
  AirFacts a = air();
  const double fwhm_px = 0.976 * a.airy_px * a.apertures_per_r0;
  for (const Row& row : {Row{3, 0.01594}, Row{4, 0.00948}, Row{6, 0.00468}, Row{10, 0.00197}}) {
    EXPECT_GE(scattered_beyond(a, row.widths * fwhm_px), row.beyond) << row.widths;
    EXPECT_LE(scattered_beyond(a, row.widths * fwhm_px), 1.3 * row.beyond) << row.widths;
  }
}

// The model's own exposures: 4 deviations hold for all of 60, and are no more than 4 times what the
// median of them has.
TEST(ImageMotion, BoundsWhatExposuresThroughScreensHave) {
  Optics o{
      .focal_length_m = 4.0, .aperture_m = 0.5, .pixel_pitch_m = 8e-6, .columns = 64, .rows = 64};
  o.spread.model = PointSpread::Model::diffraction;
  o.spread.support_px = 24;
  const SensorSeeing seeing{.r0_m = 0.12, .wind_m_per_s = 12.0};
  const double exposure_s = 5.5 * seeing.tau0_s(lambda);
  const PsfPlan plan = plan_psf(o, lambda, seeing, exposure_s);
  ASSERT_EQ(plan.screens, 6);
  const AirFacts a{.airy_px = lambda / o.aperture_m / o.pixel_angle_rad(),
                   .apertures_per_r0 = o.aperture_m / seeing.r0_at_m(lambda),
                   .apertures_blown = seeing.wind_m_per_s * exposure_s / o.aperture_m,
                   .screens = plan.screens};
  const double bound_px = 4.0 * image_motion_px(a);
  PsfModel model(o, {{lambda, 1.0}}, plan, seeing, rng_key(1, "s", 0, "turbulence"));
  std::vector<double> moved_px;
  for (int i = 0; i < 60; ++i) {
    const PsfKernel k = model.kernel({}, 100.0 * i, exposure_s);
    double x = 0, y = 0;
    for (int dy = -k.half; dy <= k.half; ++dy)
      for (int dx = -k.half; dx <= k.half; ++dx) x += k.at(dx, dy) * dx, y += k.at(dx, dy) * dy;
    moved_px.push_back(std::hypot(x, y) / plan.oversampling);
  }
  std::sort(moved_px.begin(), moved_px.end());
  EXPECT_LT(moved_px.back(), bound_px);
  EXPECT_GT(moved_px[moved_px.size() / 2], bound_px / 5.0);
}

TEST(AirTurbulence, ErrsNoMoreByRisingLevelAndNotAtAllAtTheReference) {
  for (const double light_e : {10.0, 1e3, 1e6})
    for (const int screens : {0, 1, 32}) {
      PlanFacts f = sees_a_star(light_e);
      f.air.screens = f.screens = screens;
      const ErrorBound none = AirTurbulence::error(AirTurbulence::off, f),
                       mean = AirTurbulence::error(AirTurbulence::long_exposure, f);
      EXPECT_TRUE(mean.within(none)) << light_e << " " << screens;
      EXPECT_EQ(AirTurbulence::error(AirTurbulence::short_exposure, f), ErrorBound{});
      if (screens == 0) {
        EXPECT_EQ(mean, ErrorBound{});
      }
    }
}

TEST(AirTurbulence, NothingInTheFieldNeedsNoAir) {
  const PlanFacts f = sees_a_star(0.0);
  EXPECT_EQ(AirTurbulence::error(AirTurbulence::off, f), ErrorBound{});
}

TEST(AirTurbulence, SourcesTooFaintToCountHaveNoPhotometryAndPosition) {
  const ErrorBound faint = AirTurbulence::error(AirTurbulence::off, sees_a_star(30.0));
  EXPECT_EQ(faint.position_px, 0.0);
  EXPECT_GT(faint.background_sigma, 0.0);
  EXPECT_GT(AirTurbulence::error(AirTurbulence::off, sees_a_star(1e4)).position_px, 0.5);
}

TEST(AirTurbulence, TheMeanSavesTheScreens) {
  const PlanFacts f = sees_a_star(1e3);
  EXPECT_DOUBLE_EQ(AirTurbulence::cost_s(AirTurbulence::short_exposure, f) -
                       AirTurbulence::cost_s(AirTurbulence::long_exposure, f),
                   f.kernel_s);
}

// Fried 1966: a long exposure through the air, the diffraction limit without it; both with kernels
// as long as those of the short exposure.
TEST(PsfPlan, TakesTheLevelOfTurbulenceThatItIsGiven) {
  Optics o{
      .focal_length_m = 4.0, .aperture_m = 0.5, .pixel_pitch_m = 8e-6, .columns = 64, .rows = 64};
  o.spread.model = PointSpread::Model::diffraction;
  const SensorSeeing seeing{.r0_m = 0.12, .wind_m_per_s = 12.0};
  const auto plan = [&](AirTurbulence::Level level) {
    return plan_psf(o, lambda, seeing, 3.5 * seeing.tau0_s(lambda), level);
  };
  const PsfPlan brief = plan(AirTurbulence::short_exposure),
                lasting = plan(AirTurbulence::long_exposure), still = plan(AirTurbulence::off);
  EXPECT_EQ(brief.screens, 4);
  EXPECT_EQ(lasting.exposure, ExposureKind::lasting);
  EXPECT_EQ(lasting.screens, 0);
  EXPECT_EQ(lasting.fwhm_px, brief.fwhm_px);
  EXPECT_EQ(still.exposure, ExposureKind::none);
  EXPECT_EQ(still.fwhm_px, plan_psf(o, lambda, {}, 1.0).fwhm_px);
  for (const PsfPlan& p : {lasting, still})
    EXPECT_NEAR(double(p.half_cells) / p.oversampling,
                double(brief.half_cells) / brief.oversampling, 1.0);
}

}  // namespace
}  // namespace dmise
