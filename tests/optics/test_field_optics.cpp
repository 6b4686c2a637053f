#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/optics/blur/blur_grid.h"
#include "core/optics/projection.h"
#include "core/optics/psf_model.h"

// Tables of SciPy and GalSim, made by tests/reference/field_optics.py.
#include "tests/reference/field_optics.inc"

// Vignetting and blur that change over the field, and a focus that drifts.
namespace dmise {
namespace {

constexpr double lambda = 0.55e-6;
const RngKey key = rng_key(1, "s", 0, "turbulence");

/// A pixel of lambda N, 101 x 101 of them.
Optics telescope() {
  Optics o{.focal_length_m = 0.5,
           .aperture_m = 0.1,
           .pixel_pitch_m = 2.75e-6,
           .columns = 101,
           .rows = 101};
  o.spread.model = PointSpread::Model::diffraction;
  return o;
}

/// Aberrations that grow towards the corner: defocus, astigmatism, coma and a constant sphere.
Optics aberrated() {
  Optics o = telescope();
  o.spread.varying.radius = FieldRadius::distance_px;
  const std::vector<double> px{0, 35, 70};
  o.spread.varying.wavefront = {{4, {px, {-20e-9, 10e-9, 60e-9}}},
                                {6, {px, {0, 30e-9, 90e-9}}},
                                {8, {px, {0, 40e-9, 100e-9}}},
                                {11, {px, {15e-9, 15e-9, 15e-9}}}};
  return o;
}

FieldPlace place_px(const Optics& o, double radius_px, double azimuth_deg) {
  return {radius_px / corner_px(o), azimuth_deg * deg};
}

/// A star in the middle of a frame, with the blur of a place.
ExpectedElectronImage star(const Optics& o, const FieldPlace& place, double drifted_m = 0.0) {
  Threads one(1);
  const PsfPlan plan = plan_psf(o, lambda, {}, 1.0);
  PsfModel model(o, {{lambda, 1.0}}, plan, {}, key);
  model.set_defocus(o.spread.defocus_m + drifted_m);
  BlurGrid grid(o.columns, o.rows, plan.oversampling, plan.half_cells);
  grid.set_kernels({model.kernel(place, 0.0, 1.0)}, one);
  const Arc on_cells = grid.on_cells({{50, 50}, {50, 50}, {50, 50}, 1.0});
  deposit({&on_cells, 1}, make_psf_table(grid_sigma_cells), grid.cells(), one);
  ExpectedElectronImage image(o.columns, o.rows);
  grid.blur_into(image, o.spread.resampling, one);
  return image;
}

/// As tests/reference/field_optics.py: of the middle 61 x 61 pixels.
struct Moments {
  double x, y, sigma_x, sigma_y, xy, peak;
};
Moments moments(const ExpectedElectronImage& image) {
  constexpr int half = 30;
  double light = 0, x = 0, y = 0, seen = 0, sx = 0, sy = 0, xx = 0, yy = 0, xy = 0, peak = 0;
  for (int j = -half; j <= half; ++j)
    for (int i = -half; i <= half; ++i) {
      const double e = image.at(50 + i, 50 + j);
      light += e, x += e * i, y += e * j, peak = std::max(peak, e);
      const double w = e * std::exp(-0.5 * (i * i + j * j) / 16.0);
      seen += w, sx += w * i, sy += w * j, xx += w * i * i, yy += w * j * j, xy += w * i * j;
    }
  sx /= seen, sy /= seen;
  return {x / light,
          y / light,
          std::sqrt(xx / seen - sx * sx),
          std::sqrt(yy / seen - sy * sy),
          xy / seen - sx * sy,
          peak / light};
}

/// GalSim's wavefronts have the other sign: its images are ours turned by half.
void expect_agreement(const Moments& m, const double* galsim) {
  EXPECT_NEAR(m.x, -galsim[0], 0.02);
  EXPECT_NEAR(m.y, -galsim[1], 0.02);
  EXPECT_NEAR(m.sigma_x, galsim[2], 0.02 * galsim[2]);
  EXPECT_NEAR(m.sigma_y, galsim[3], 0.02 * galsim[3]);
  EXPECT_NEAR(m.xy, galsim[4], 0.02 * galsim[2] * galsim[3]);
  EXPECT_NEAR(m.peak, galsim[5], 0.02 * galsim[5]);
}

// Reference: scipy's PchipInterpolator, at 83 angles.
TEST(VignettingTable, IsScipysMonotoneInterpolation) {
  Optics o = telescope();
  o.pixel_pitch_m = 1e-5;
  o.columns = o.rows =
      160001;  // half a million pixels would be the frame's half: the plane is enough
  o.vignetting.table = {{0, 4, 9, 15, 22, 30, 41}, {1, 0.995, 0.96, 0.97, 0.8, 0.35, 0.1}};
  for (int i = 0; i <= 82; ++i) {
    EXPECT_NEAR(o.vignetting.table(0.5 * i), scipy_pchip[i], 1e-9) << i;
    const double r_px = o.focal_length_px() * std::tan(0.5 * i * deg);
    const PixelPosition middle = principal_point(o);
    for (const double azimuth : {0.0, 2.0})
      EXPECT_NEAR(relative_illumination(o, {middle.x_px + r_px * std::cos(azimuth),
                                            middle.y_px + r_px * std::sin(azimuth)}),
                  scipy_pchip[i], 1e-6)
          << i;
  }
}

TEST(VignettingTable, StaysWhatItIsBeyondItsEndsAndIsDarkWhereNothingIsImaged) {
  Optics o = telescope();
  o.projection = Projection::equisolid;
  o.vignetting.table = {{10, 60}, {0.9, 0.2}};
  const double f = o.focal_length_px();
  const auto at = [&](double r_px) {
    return relative_illumination(o, principal_point(o) + PixelPosition{r_px, 0.0});
  };
  EXPECT_DOUBLE_EQ(at(0.0), 0.9);
  EXPECT_DOUBLE_EQ(at(f * Projection::equisolid.height(80 * deg)), 0.2);
  EXPECT_EQ(at(2.01 * f), 0.0);
  o.vignetting.table_radius = FieldRadius::distance_px;
  EXPECT_DOUBLE_EQ(at(2.01 * f), 0.2);
}

TEST(VignettingTable, SaysHowSteepItIs) {
  Optics o = telescope();
  EXPECT_EQ(illumination_slope_per_px(o), 0.0);
  o.vignetting.table = {{0, 100}, {1.0, 0.5}};
  o.vignetting.table_radius = FieldRadius::distance_px;
  // Straight: 0.005 a pixel, of 0.64 in the corner 71.4 px away.
  EXPECT_NEAR(illumination_slope_per_px(o), 0.005 / 0.643, 1e-4);
}

// Reference: GalSim 2.8's OpticalPSF with the aberrations of each place.
TEST(FieldBlur, PupilsAreThoseOfGalSimOverTheField) {
  const Optics o = aberrated();
  const auto at = [&](double radius_px, double azimuth_deg) {
    return moments(star(o, place_px(o, radius_px, azimuth_deg)));
  };
  expect_agreement(at(0, 0), galsim_place_0);
  expect_agreement(at(35, 0), galsim_place_1);
  expect_agreement(at(50, 90), galsim_place_2);
  expect_agreement(at(70, 0), galsim_place_3);
  expect_agreement(at(70, 225), galsim_place_4);
}

// Coma of a [m rms] puts the light sqrt(8) 2 N a outwards of the chief ray: the mean slope of
// Noll's term 8 is its value at the edge.
TEST(FieldBlur, ComaDisplacesTheLightFromTheChiefRay) {
  const Optics o = aberrated();
  const auto shift = centroid_of_field_px(o, place_px(o, 70, 0));
  EXPECT_NEAR(shift[0], std::sqrt(8.0) * 100e-9 * 2 * 5 / o.pixel_pitch_m, 1e-9);
  EXPECT_NEAR(shift[1], 0.0, 1e-12);
  // The kernel ends where some of its light is still to come.
  const PsfPlan plan = plan_psf(o, lambda, {}, 1.0);
  const PsfKernel k =
      PsfModel(o, {{lambda, 1.0}}, plan, {}, key).kernel(place_px(o, 70, 90), 0.0, 1.0);
  double y = 0;
  for (int dy = -k.half; dy <= k.half; ++dy)
    for (int dx = -k.half; dx <= k.half; ++dx) y += k.at(dx, dy) * dy;
  EXPECT_NEAR(y / plan.oversampling, shift[0], 0.06);
}

TEST(FieldBlur, ATiltMovesTheLightAlone) {
  Optics o = telescope();
  o.spread.varying.radius = FieldRadius::distance_px;
  o.spread.varying.wavefront = {{2, {{0, 70}, {0, 50e-9}}}};
  const Moments m = moments(star(o, place_px(o, 70, 90)));
  EXPECT_NEAR(m.x, 0.0, 0.005);
  EXPECT_NEAR(m.y, 4 * 50e-9 * 5 / o.pixel_pitch_m, 0.01);
}

Optics of_widths(std::vector<double> px, std::vector<double> radial,
                 std::vector<double> tangential) {
  Optics o = telescope();
  o.spread.model = PointSpread::Model::gaussian;
  o.aperture_m = 0.5;  // diffraction hardly widens
  o.psf_fwhm_px = 0.0;
  o.spread.varying = {.radius = FieldRadius::distance_px,
                      .fwhm_radial_px = {px, std::move(radial)},
                      .fwhm_tangential_px = {px, std::move(tangential)}};
  return o;
}

/// Variances of a star's pixels without the pixels' own.
GaussianShape variances(const ExpectedElectronImage& image) {
  GaussianShape v{-1 / 12.0, 0.0, -1 / 12.0};
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.columns; ++x) {
      const double e = image.at(x, y);
      v.xx += e * (x - 50) * (x - 50), v.xy += e * (x - 50) * (y - 50),
          v.yy += e * (y - 50) * (y - 50);
    }
  return v;
}

// Against the closed form: covariances of a Gaussian turned with the azimuth.
TEST(FieldBlur, GaussiansAreAsWideAsTheTableAlongAndAcrossTheRadius) {
  const Optics o = of_widths({0, 35, 70}, {2, 3, 6}, {2, 2.5, 3});
  for (const double azimuth_deg : {0.0, 90.0, 45.0, 200.0}) {
    const GaussianShape v = variances(star(o, place_px(o, 70, azimuth_deg)));
    const double along = std::pow(6 / fwhm_per_sigma, 2), across = std::pow(3 / fwhm_per_sigma, 2);
    const double c = std::cos(azimuth_deg * deg), s = std::sin(azimuth_deg * deg);
    const double airy = std::pow(diffraction_sigma_px(o, lambda), 2);
    EXPECT_NEAR(v.xx, along * c * c + across * s * s + airy, 0.01) << azimuth_deg;
    EXPECT_NEAR(v.yy, along * s * s + across * c * c + airy, 0.01) << azimuth_deg;
    EXPECT_NEAR(v.xy, (along - across) * c * s, 0.01) << azimuth_deg;
  }
}

TEST(FieldBlur, ATableOfOneRowIsTheSameEverywhereAndRoundOnTheAxis) {
  const Optics o = of_widths({40}, {4}, {2});
  const double airy = std::pow(diffraction_sigma_px(o, lambda), 2);
  for (const double radius_px : {1.0, 40.0, 71.0})
    EXPECT_NEAR(gaussian_at(o, place_px(o, radius_px, 0), lambda).xx,
                std::pow(4 / fwhm_per_sigma, 2) + airy, 1e-12);
  const GaussianShape axis = gaussian_at(o, {}, lambda);
  EXPECT_DOUBLE_EQ(axis.xx, axis.yy);
  EXPECT_NEAR(axis.xx, 10 / std::pow(fwhm_per_sigma, 2) + airy, 1e-12);
}

TEST(FieldBlur, BeyondTheLastRadiusOfAFisheyeTheBlurIsThatOfTheLast) {
  Optics o = of_widths({0, 40}, {2, 5}, {2, 3});
  o.projection = Projection::equisolid;
  o.focal_length_m = 30 * o.pixel_pitch_m;  // the corner is beyond what the lens images
  o.aperture_m = 0.3 * o.focal_length_m;
  o.spread.varying.radius = FieldRadius::angle_deg;
  ASSERT_FALSE(unproject(o, {0, 0}));
  const double corner = gaussian_at(o, {1.0, 0.0}, lambda).xx;
  EXPECT_DOUBLE_EQ(corner, gaussian_at(o, place_px(o, 30 * 0.7, 0.0), lambda).xx);
  for (const double height : table_heights(o)) EXPECT_LE(height, 1.0);
}

/// The light of stars over a frame, blurred by n x n kernels, and by the kernel of each place.
struct Blurred {
  ExpectedElectronImage image, exact;
};
Blurred blurred(const Optics& o, int n, const std::vector<PixelPosition>& stars, bool in_tiles) {
  Threads two(2);
  const PsfPlan plan = plan_psf(o, lambda, {}, 1.0);
  PsfModel model(o, {{lambda, 1.0}}, plan, {}, key);
  const PsfTable table = make_psf_table(grid_sigma_cells);
  const auto place = [&](PixelPosition at) {
    const PixelPosition d = at - principal_point(o);
    return FieldPlace{std::hypot(d.x_px, d.y_px) / corner_px(o), std::atan2(d.y_px, d.x_px)};
  };
  Blurred b{ExpectedElectronImage(o.columns, o.rows), ExpectedElectronImage(o.columns, o.rows)};
  BlurGrid grid(o.columns, o.rows, plan.oversampling, plan.half_cells, n, n, in_tiles);
  std::vector<PsfKernel> kernels;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
      kernels.push_back(model.kernel(
          place({i * (o.columns - 1.0) / (n - 1), j * (o.rows - 1.0) / (n - 1)}), 0.0, 1.0));
  grid.set_kernels(kernels, two);
  BlurGrid single(o.columns, o.rows, plan.oversampling, plan.half_cells);
  for (const PixelPosition at : stars) {
    const Arc arc = grid.on_cells({at, at, at, 1000.0});
    deposit({&arc, 1}, table, grid.cells(), two);
    single.set_kernels({model.kernel(place(at), 0.0, 1.0)}, two);
    deposit({&arc, 1}, table, single.cells(), two);
    single.blur_into(b.exact, o.spread.resampling, two);
    single.clear(two);
  }
  grid.blur_into(b.image, o.spread.resampling, two);
  return b;
}

double sum_of(const ExpectedElectronImage& image) {
  double sum = 0;
  for (const float e : image.pixels) sum += e;
  return sum;
}

TEST(FieldBlur, TilesAreTheWholeGrid) {
  const Optics o = of_widths({0, 70}, {2, 5}, {2, 3});
  // One of them beside the frame, whose blur reaches in.
  const std::vector<PixelPosition> stars{{50, 50}, {3, 4}, {97, 20}, {30, 75}, {-3, 60}};
  for (const int n : {3, 5}) {
    const auto tiles = blurred(o, n, stars, true).image, whole = blurred(o, n, stars, false).image;
    for (std::size_t i = 0; i < whole.pixels.size(); ++i)
      ASSERT_NEAR(tiles.pixels[i], whole.pixels[i], 1e-3) << n;
    EXPECT_GT(tiles.at(0, 60), 5.0f);
  }
}

// The planner's bound of what a grid of kernels misplaces, against kernels of each place.
TEST(FieldBlur, KernelsBetweenPlacesAreWithinTheirBound) {
  const std::vector<PixelPosition> stars{{12.5, 12.5}, {37, 62.5}, {62.5, 88}, {88, 24}};
  const auto expect_within = [&](const Optics& o, const std::vector<int>& sides, double least) {
    double bound = 1.0;
    for (const int n : sides) {
      const Blurred b = blurred(o, n, stars, true);
      EXPECT_NEAR(sum_of(b.image), sum_of(b.exact), 2e-3 * sum_of(b.exact));
      double elsewhere = 0;
      for (std::size_t i = 0; i < b.image.pixels.size(); ++i)
        elsewhere += 0.5 * std::abs(b.image.pixels[i] - b.exact.pixels[i]);
      elsewhere /= sum_of(b.exact);
      bound = field_grid_error(o, lambda, n).misplaced;
      EXPECT_LE(elsewhere, bound) << n;
      RecordProperty(std::to_string(bound) + "_" + std::to_string(n), std::to_string(elsewhere));
    }
    EXPECT_LT(bound, least);
  };
  expect_within(aberrated(), {3, 5}, 0.6);
  expect_within(of_widths({0, 35, 70}, {2, 3, 5}, {2, 2.5, 3}), {3, 5, 9}, 0.05);
}

// Reference: GalSim 2.8's OpticalPSF(defocus); none, 40 and 120 um at f/5.
TEST(FocusDrift, OfAPupilIsGalSimsDefocus) {
  Optics o = telescope();
  o.spread.drift = {.um_per_hour = 120.0, .run_s = 3600.0};
  expect_agreement(moments(star(o, {}, 0.0)), galsim_defocus_0);
  expect_agreement(moments(star(o, {}, o.spread.drift.at_m(1200.0))), galsim_defocus_1);
  expect_agreement(moments(star(o, {}, o.spread.drift.at_m(3600.0))), galsim_defocus_2);
}

// The closed form: an even ring of outer diameter d = defocus / N has variances of (1 + e^2) d^2 /
// 16 along an axis.
TEST(FocusDrift, OfAGaussianIsTheGeometricalDisc) {
  for (const double obscuration : {0.0, 0.5}) {
    Optics o = telescope();
    o.spread.model = PointSpread::Model::gaussian;
    o.obscuration = obscuration;
    o.psf_fwhm_px = 2.0;
    o.spread.drift = {.start_um = 165.0};
    const double d_px = 165e-6 / 5 / o.pixel_pitch_m;  // 12 px
    const double sigma_px = psf_sigma_px(o, lambda);
    const GaussianShape focused = variances(star(o, {})),
                        v = variances(star(o, {}, o.spread.drift.at_m(0.0)));
    EXPECT_NEAR(focused.xx, sigma_px * sigma_px, 0.02);
    const double expected =
        sigma_px * sigma_px + (1 + obscuration * obscuration) * d_px * d_px / 16;
    EXPECT_NEAR(v.xx, expected, 0.02 * expected) << obscuration;
    EXPECT_NEAR(v.yy, expected, 0.02 * expected) << obscuration;
  }
}

TEST(FocusDrift, GoesWithTimeAndTheDaysTemperature) {
  const FocusDrift drift{.start_um = 5.0,
                         .um_per_hour = 1.0,
                         .um_per_k = 2.0,
                         .swing_k = 10.0,
                         .warmest_h = 12.0,
                         .run_s = 48 * 3600.0};
  EXPECT_NEAR(drift.at_m(0.0), 5e-6, 1e-15);
  EXPECT_NEAR(drift.at_m(12 * 3600.0), 5e-6 + 12e-6 + 20e-6, 1e-12);  // 10 K warmer
  EXPECT_NEAR(drift.at_m(24 * 3600.0), 5e-6 + 24e-6, 1e-12);
  // Half an hour after its second noon: 1 um/h of rise against the cosine.
  double most = 0;
  for (int s = 0; s <= 48 * 3600; s += 10) most = std::max(most, drift.at_m(s));
  EXPECT_GE(drift.max_m(), most);
  EXPECT_LT(drift.max_m(), 1.0001 * most);
  EXPECT_EQ(FocusDrift{}.max_m(), 0.0);
  EXPECT_FALSE((FocusDrift{.um_per_k = 3.0}).any());
}

TEST(FocusDrift, AsWideAsTheFrameIsABlurAndWiderThanAKernelIsRefused) {
  Optics o = telescope();
  o.spread.model = PointSpread::Model::gaussian;
  o.psf_fwhm_px = 3.0;
  o.spread.drift = {.start_um = 101 * 2.75 * 5};  // 101 px
  const auto image = star(o, {}, o.spread.drift.at_m(0.0));
  const double disc_px = 101.0 * 101.0 * pi / 4;
  EXPECT_NEAR(image.at(50, 50), 1 / disc_px, 0.03 / disc_px);
  EXPECT_NEAR(sum_of(image), 1.0, 0.03);
  o.spread.drift.start_um *= 20;
  try {
    plan_psf(o, lambda, {}, 1.0);
    FAIL();
  } catch (const ConfigError& e) {
    EXPECT_NE(std::string(e.what()).find("optics.focus_drift: its blur of"), std::string::npos)
        << e.what();
  }
}

TEST(FocusDrift, InFocusThereIsTheBlurOfTheCamera) {
  Optics still = telescope(), o = telescope();
  still.spread.support_px = o.spread.support_px = 40;
  o.spread.drift = {.start_um = 30.0};
  const auto a = star(still, {}), b = star(o, {}, 0.0);
  for (std::size_t i = 0; i < a.pixels.size(); ++i) ASSERT_NEAR(a.pixels[i], b.pixels[i], 1e-5);
}

}  // namespace
}  // namespace dmise
