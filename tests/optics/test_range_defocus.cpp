#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "core/base/units.h"
#include "core/effects/plan_facts.h"
#include "core/optics/blur/defocus_blur.h"
#include "core/optics/blur/extended_light.h"
#include "core/optics/range_defocus.h"

// Tables of GalSim, made by tests/reference/range_defocus.py.
#include "tests/reference/range_defocus.inc"

// Objects at a finite range before optics that are focused at infinity.
namespace dmise {
namespace {

constexpr double lambda = 0.55e-6;
constexpr int side = 121, middle = 60;
constexpr std::array radii_px{10.0, 20.0, 30.0, 40.0};  // where the tables have encircled light

/// A telescope of 3 m with pixels of half lambda / D: 65 of them are the disc of 500 km.
Optics three_metres(PointSpread::Model model = PointSpread::Model::diffraction) {
  Optics o{.focal_length_m = 45.0,
           .aperture_m = 3.0,
           .pixel_pitch_m = 0.5 * lambda * 15.0,
           .columns = side,
           .rows = side};
  o.spread.model = model;
  return o;
}

double disc_px(const Optics& o, double range_m) {
  return o.aperture_m / range_m / o.pixel_angle_rad();
}

/// Light of arcs at a range, with what `DefocusBlur` says of it.
struct Drawn {
  ExpectedElectronImage image;
  Deposited inside;
};
Drawn drawn(const Optics& o, const std::vector<Arc>& arcs, double range_m, int threads = 1) {
  Threads workers(threads);
  const PsfPlan plan = plan_psf(o, lambda, {}, 1.0);
  std::optional<PsfModel> model;
  if (plan.method != PointSpread::Method::deposit)
    model.emplace(o, std::vector<WavelengthShare>{{lambda, 1.0}}, plan, std::nullopt, RngKey{});
  DefocusBlur blur(o, plan, model ? &*model : nullptr, 0);
  blur.begin(0.0, 1.0);
  Drawn d{ExpectedElectronImage(o.columns, o.rows), {}};
  d.inside = blur.deposit(arcs, o.spread.defocus_m - range_defocus_m(o, range_m), d.image, workers);
  return d;
}

Arc point(double x_px, double y_px, double signal_e = 1.0) {
  return {{x_px, y_px}, {x_px, y_px}, {x_px, y_px}, signal_e};
}

double sum_of(const ExpectedElectronImage& image) {
  return std::accumulate(image.pixels.begin(), image.pixels.end(), 0.0);
}

double within(const ExpectedElectronImage& image, double radius_px) {
  double sum = 0.0;
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.columns; ++x)
      if (std::hypot(x - middle, y - middle) <= radius_px) sum += double(image.at(x, y));
  return sum;
}

template <std::size_t n>
void expect_galsim(const double (&table)[n], double obscuration, double range_m) {
  Optics o = three_metres();
  o.obscuration = obscuration;
  const auto [image, inside] = drawn(o, {point(middle, middle)}, range_m);
  constexpr std::size_t pixels = n - radii_px.size();
  const double peak = *std::max_element(table, table + pixels);
  double worst = 0.0;
  for (std::size_t i = 0; i < pixels; ++i)
    worst = std::max(worst, std::abs(image.at(middle + int(i), middle) - table[i]) / peak);
  EXPECT_LT(worst, 0.02) << range_m << " m, " << obscuration;
  for (std::size_t i = 0; i < radii_px.size(); ++i)
    EXPECT_NEAR(within(image, radii_px[i]), table[pixels + i], 0.02) << radii_px[i] << " px";
  EXPECT_NEAR(inside.x_px, middle, 0.01);
  EXPECT_NEAR(inside.y_px, middle, 0.01);
}

// Reference: GalSim 2.8's OpticalPSF(defocus), row through the middle and encircled light.
TEST(RangeDefocus, OfAPupilIsGalSims) {
  expect_galsim(galsim_disc_500_km, 0.0, 500e3);
  expect_galsim(galsim_disc_1000_km, 0.0, 1000e3);
  expect_galsim(galsim_disc_2000_km, 0.0, 2000e3);
}

TEST(RangeDefocus, OfAnObscuredPupilIsGalSims) {
  expect_galsim(galsim_ring_500_km, 0.4, 500e3);
  expect_galsim(galsim_ring_1000_km, 0.4, 1000e3);
  expect_galsim(galsim_ring_2000_km, 0.4, 2000e3);
}

// Aperture / range, 1.24 arcsec of 3 m at 500 km: even light on a disc, none in the ring's hole.
TEST(RangeDefocus, OfAGaussianIsADiscOfApertureOverRange) {
  for (const double obscuration : {0.0, 0.4}) {
    Optics o = three_metres(PointSpread::Model::gaussian);
    o.obscuration = obscuration;
    o.psf_fwhm_px = 1.5;
    EXPECT_NEAR(o.aperture_m / 500e3 / arcsec, 1.2376, 1e-4);
    const double d_px = disc_px(o, 500e3);
    const auto [image, inside] = drawn(o, {point(middle, middle)}, 500e3);
    const double area_px2 = pi * d_px * d_px / 4 * (1 - obscuration * obscuration);
    EXPECT_NEAR(image.at(middle + 25, middle), 1 / area_px2, 0.02 / area_px2);
    EXPECT_NEAR(image.at(middle, middle - 20), 1 / area_px2, 0.02 / area_px2);
    EXPECT_NEAR(image.at(middle, middle), obscuration > 0 ? 0.0 : 1 / area_px2, 0.02 / area_px2);
    EXPECT_NEAR(within(image, 0.5 * d_px + 4), 1.0, 1e-3);
    EXPECT_NEAR(inside.signal_e, 1.0, 1e-3);
    EXPECT_NEAR(sum_of(image), inside.signal_e, 1e-5);
  }
}

// Light and centroid of a point anywhere on a pixel, and none lost between tiles.
TEST(RangeDefocus, KeepsLightAndCentroid) {
  Optics o = three_metres();
  o.columns = o.rows = 400;
  for (const auto model : {PointSpread::Model::gaussian, PointSpread::Model::diffraction}) {
    o.spread.model = model;
    const auto [image, inside] = drawn(o, {point(200.3, 180.8, 1e6)}, 700e3);
    EXPECT_NEAR(sum_of(image), 1e6, 1e3);
    EXPECT_NEAR(inside.signal_e, 1e6, 1e3);
    EXPECT_NEAR(inside.x_px, 200.3, 0.01);
    EXPECT_NEAR(inside.y_px, 180.8, 0.01);
  }
}

// The trail of a disc has its chords as profile: sqrt(1 - (2 y / d)^2), of full width d.
TEST(RangeDefocus, OfATrailIsAsWideAsTheDisc) {
  Optics o = three_metres(PointSpread::Model::gaussian);
  o.columns = 900;
  o.rows = 300;
  o.psf_fwhm_px = 1.5;
  const double d_px = disc_px(o, 500e3);
  const Arc trail{{-100, 150}, {450, 150}, {1000, 150}, 1100.0};  // an electron a pixel
  const auto [image, inside] = drawn(o, {trail}, 500e3);
  EXPECT_NEAR(inside.signal_e, 900.0, 1.0);
  const double peak = 4 / (pi * d_px);
  for (const int x : {3, 200, 451, 896})
    for (int y = -28; y <= 28; y += 4)
      EXPECT_NEAR(image.at(x, 150 + y), peak * std::sqrt(1 - 4.0 * y * y / (d_px * d_px)),
                  0.01 * peak)
          << x << " " << y;
  EXPECT_LT(image.at(450, 150 + 37), 0.01 * peak);
}

// A wider disc than any kernel holds, a smaller one than a pixel, and a point beside the frame.
TEST(RangeDefocus, HardCasesKeepTheirLight) {
  Optics o = three_metres(PointSpread::Model::gaussian);
  o.psf_fwhm_px = 0.3;
  const double far = disc_px(o, 1e3);
  EXPECT_GT(far, 30000.0);
  const DefocusScale scale(o, plan_psf(o, lambda, {}, 1.0));
  EXPECT_EQ(scale.disc_px(-range_defocus_m(o, 1e3)), -widest_disc_px);
  EXPECT_EQ(drawn(o, {}, 500e3).inside.signal_e, 0.0);
  EXPECT_NEAR(drawn(o, {point(middle, middle)}, 50e6).inside.signal_e, 1.0, 1e-3);
  const auto beside = drawn(o, {point(-20, middle)}, 500e3);
  EXPECT_GT(beside.inside.signal_e, 0.1);
  EXPECT_LT(beside.inside.signal_e, 0.2);
  EXPECT_NEAR(sum_of(beside.image), beside.inside.signal_e, 1e-6);
  EXPECT_EQ(drawn(o, {point(-2000, middle)}, 500e3).inside.signal_e, 0.0);
}

TEST(RangeDefocus, IsTheSameByAnyNumberOfThreads) {
  const std::vector<Arc> arcs{{{-50, 10}, {30, 60}, {140, 90}, 1e5}, point(100, 30, 1e3)};
  const auto one = drawn(three_metres(), arcs, 600e3, 1),
             four = drawn(three_metres(), arcs, 600e3, 4);
  EXPECT_EQ(one.image.pixels, four.image.pixels);
  EXPECT_EQ(one.inside.signal_e, four.inside.signal_e);
}

/// Share of the light of `a` that is elsewhere in `b`.
double elsewhere(const ExpectedElectronImage& a, const ExpectedElectronImage& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    sum += 0.5 * std::abs(a.pixels[i] - b.pixels[i]);
  return sum / sum_of(a);
}

// Steps misplace no more than the level states, at the widest and in between.
TEST(RangeDefocus, StepsMisplaceNoMoreThanTheirLevelStates) {
  for (const auto model : {PointSpread::Model::gaussian, PointSpread::Model::diffraction})
    for (const double obscuration : {0.0, 0.4}) {
      Optics o = three_metres(model);
      o.obscuration = obscuration;
      const DefocusScale scale(o, plan_psf(o, lambda, {}, 1.0));
      for (std::size_t level = 1; level < RangeDefocus::misplaced.size(); ++level)
        for (const double range_m : {500e3, 3000e3}) {
          const double share = RangeDefocus::misplaced[level];
          const double exact_m = -range_defocus_m(o, range_m);
          const double drawn_m = scale.stepped_m(exact_m, 0.0, share);
          const double bound = scale.misplaced(scale.disc_px(exact_m), scale.disc_px(drawn_m));
          EXPECT_LE(bound, share * (1 + 1e-9));
          if (drawn_m == 0.0 || level == 4) continue;
          const auto exact = drawn(o, {point(middle, middle)}, range_m),
                     stepped = drawn(o, {point(middle, middle)},
                                     o.focal_length_m * o.focal_length_m / -drawn_m);
          EXPECT_LE(elsewhere(exact.image, stepped.image), share)
              << range_m << " m, level " << level << ", model " << int(model);
        }
    }
}

TEST(RangeDefocus, OfAFarObjectOrALowLevelIsNone) {
  const Optics o = three_metres();
  const DefocusScale scale(o, plan_psf(o, lambda, {}, 1.0));
  EXPECT_EQ(scale.stepped_m(-range_defocus_m(o, 3.8e8), 0.0, 0.01), 0.0);
  EXPECT_NE(scale.stepped_m(-range_defocus_m(o, 3.6e7), 0.0, 0.003), 0.0);
  Optics small = o;
  small.aperture_m = 0.1;
  small.focal_length_m = 0.5;
  small.pixel_pitch_m = 5e-6;
  const DefocusScale coarse(small, plan_psf(small, lambda, {}, 1.0));
  EXPECT_EQ(coarse.stepped_m(-range_defocus_m(small, 500e3), 0.0, 0.003), 0.0);
}

// An object at the distance of focus is as sharp as stars are of a camera focused at infinity.
TEST(RangeDefocus, IsNoneAtTheDistanceOfFocus) {
  Optics o = three_metres();
  const auto star = drawn(o, {point(middle, middle)}, 1e15);
  o.spread.focus_distance_m = 800e3;
  o.spread.defocus_m = range_defocus_m(o, 800e3);
  const auto object = drawn(o, {point(middle, middle)}, 800e3);
  for (std::size_t i = 0; i < star.image.pixels.size(); ++i)
    ASSERT_NEAR(object.image.pixels[i], star.image.pixels[i], 5e-4);  // kernels of other lengths
  // Stars are then as wide as an object of that distance before.
  const auto blurred_star = drawn(o, {point(middle, middle)}, 1e15);
  const auto before = drawn(three_metres(), {point(middle, middle)}, 800e3);
  EXPECT_LT(elsewhere(blurred_star.image, before.image), 0.01);
}

TEST(RangeDefocus, IsPlannedByWhatItMisplaces) {
  PlanFacts f;
  f.sky.push_back({});
  EXPECT_EQ(RangeDefocus::error(0, f), ErrorBound{});
  EXPECT_EQ(RangeDefocus::cost_s(3, f), 0.0);
  f.out_of_focus.push_back({.misplaced = 0.02, .cost_s = 0.5});
  EXPECT_EQ(RangeDefocus::error(0, f), RangeDefocus::error(2, f));
  EXPECT_LT(RangeDefocus::error(3, f).photometry_mag, RangeDefocus::error(2, f).photometry_mag);
  EXPECT_EQ(RangeDefocus::error(4, f), ErrorBound{});
  EXPECT_EQ(RangeDefocus::cost_s(2, f), 0.0);
  EXPECT_EQ(RangeDefocus::cost_s(3, f), 0.5);
  f.out_of_focus.push_back({.misplaced = 1.0, .cost_s = 0.5});
  EXPECT_FALSE(RangeDefocus::error(0, f).within(draft_budget));
  EXPECT_LT(RangeDefocus::error(1, f).position_px, unbounded);
}

}  // namespace
}  // namespace dmise
