#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/optics/psf_model.h"
#include "core/optics/psf_table.h"

// Kernels that a camera's plan makes: their transfer function, measured in the kernel times that of
// the deposits' Gaussian, against theory.
namespace dmise {
namespace {

constexpr double lambda = 0.55e-6;
const RngKey key = rng_key(1, "s", 0, "turbulence");

Optics telescope() {
  Optics o{
      .focal_length_m = 4.0, .aperture_m = 0.4, .pixel_pitch_m = 4e-6, .columns = 64, .rows = 64};
  o.spread.model = PointSpread::Model::diffraction;
  o.spread.support_px = 24;
  return o;
}

PsfKernel kernel_of_camera(const Optics& o, const std::optional<SensorSeeing>& seeing = {},
                           double exposure_s = 1.0, const FieldPlace& place = {},
                           std::vector<WavelengthShare> band = {{lambda, 1.0}}) {
  const PsfPlan plan = plan_psf(o, lambda, seeing, exposure_s);
  return PsfModel(o, std::move(band), plan, seeing, key).kernel(place, 0.0, exposure_s);
}

/// Transfer function along x or y at `nu` [cycles a radian], the deposits' Gaussian put back.
double otf(const Optics& o, const PsfKernel& k, double nu, bool along_y = false) {
  const int cells = plan_psf(o, lambda, {}, 1.0).oversampling;
  const double cell_rad = o.pixel_angle_rad() / cells;
  double h = 0;
  for (int dy = -k.half; dy <= k.half; ++dy)
    for (int dx = -k.half; dx <= k.half; ++dx)
      h += k.at(dx, dy) * std::cos(2 * pi * nu * cell_rad * (along_y ? dy : dx));
  return h * jitter_otf(nu, grid_sigma_cells * cell_rad);
}

double sum(const PsfKernel& k) { return std::accumulate(k.values.begin(), k.values.end(), 0.0); }

PixelPosition centroid(const PsfKernel& k) {
  double x = 0, y = 0;
  for (int dy = -k.half; dy <= k.half; ++dy)
    for (int dx = -k.half; dx <= k.half; ++dx) x += k.at(dx, dy) * dx, y += k.at(dx, dy) * dy;
  return {x, y};
}

TEST(PsfModel, WithoutAberrationsIsTheDiffractionLimit) {
  Optics o = telescope();
  o.spread.support_px = 200;
  for (double obscuration : {0.0, 0.4}) {
    o.obscuration = obscuration;
    const PsfKernel k = kernel_of_camera(o);
    EXPECT_NEAR(sum(k), 1.0, 1e-6);
    for (double share : {0.1, 0.3, 0.5, 0.8})
      EXPECT_NEAR(otf(o, k, share * o.aperture_m / lambda),
                  diffraction_otf(share * o.aperture_m / lambda, lambda, o.aperture_m, obscuration),
                  0.005)
          << obscuration << " " << share;
  }
  // A thread of a pupil: its light runs far, and what the kernel holds is still a point spread.
  o.obscuration = 0.99;
  EXPECT_NEAR(sum(kernel_of_camera(o)), 1.0, 1e-6);
}

TEST(PsfModel, ThePupilsKernelIsThatOfTheTransferFunction) {
  Optics o = telescope(), spidered = telescope();
  o.obscuration = spidered.obscuration = 0.3;
  spidered.spread.spiders = 1;  // without width: takes the way through the pupil
  const PsfKernel a = kernel_of_camera(o), b = kernel_of_camera(spidered);
  double worst = 0;
  for (std::size_t i = 0; i < a.values.size(); ++i)
    worst = std::max(worst, double(std::abs(a.values[i] - b.values[i])));
  EXPECT_LT(worst, 2e-3 * a.at(0, 0));
}

// Geometrical optics: a blur disc of defocus / N, 2 J1(x) / x; good where it is far wider than the
// Airy pattern.
TEST(PsfModel, DefocusIsTheGeometricalDisc) {
  Optics o = telescope();
  o.spread.defocus_m = 4e-3;  // 400 um: 100 px
  o.spread.support_px = 160;
  const PsfKernel k = kernel_of_camera(o);
  const double disc_rad = o.spread.defocus_m / o.f_number() / o.focal_length_m;
  for (double cycles : {0.3, 0.6, 1.5}) {
    const double nu = cycles / disc_rad;
    EXPECT_NEAR(otf(o, k, nu),
                defocus_otf(nu, disc_rad) * diffraction_otf(nu, lambda, o.aperture_m), 0.03)
        << cycles;
  }
}

/// Radius that holds half of the light, in pixels.
double half_light_radius_px(const PsfKernel& k, int cells) {
  std::vector<std::pair<double, double>> rings;
  for (int dy = -k.half; dy <= k.half; ++dy)
    for (int dx = -k.half; dx <= k.half; ++dx)
      rings.emplace_back(std::hypot(dx, dy) / cells, k.at(dx, dy));
  std::sort(rings.begin(), rings.end());
  double light = 0;
  for (const auto& [radius, share] : rings) {
    light += share;
    if (light >= 0.5) return radius;
  }
  return 0;
}

// Geometrical optics: half of a uniform disc of diameter defocus / N lies within its radius / root
// of 2. 18 waves over the pupil of the second are more than 128 samples could tell.
TEST(PsfModel, HalfTheLightOfADefocusLiesWhereGeometryPutsIt) {
  for (double defocus_m : {4e-3, 10e-3}) {
    Optics o = telescope();
    o.pixel_pitch_m = 5e-6;
    o.spread.support_px = 0;
    o.spread.defocus_m = defocus_m;
    const double disc_px = defocus_m / o.f_number() / o.pixel_pitch_m;
    const int cells = plan_psf(o, lambda, {}, 1.0).oversampling;
    EXPECT_NEAR(half_light_radius_px(kernel_of_camera(o), cells) / (disc_px / std::sqrt(8.0)), 1.0,
                0.01)
        << defocus_m;
  }
}

std::string refusal_of(const Optics& o, const std::optional<SensorSeeing>& seeing = {}) {
  try {
    sample_pupils(o, {{lambda, 1.0}}, plan_psf(o, lambda, seeing, 1.0), seeing);
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "";
}

// Noll 1976: term 4 is sqrt(3) (2 rho^2 - 1), term 6 sqrt(6) rho^2 cos 2 theta.
TEST(PsfModel, WavefrontsTooSteepForTheirSamplesAreRefusedAtTheirKey) {
  EXPECT_NEAR(steepest_slope({.wavefront = {{4, 1.0}}}), 4 * std::sqrt(3), 1e-2);
  EXPECT_NEAR(steepest_slope({.wavefront = {{6, 1.0}}}), 2 * std::sqrt(6), 1e-2);
  Optics o = telescope();
  EXPECT_EQ(refusal_of(o), "");
  o.spread.wavefront = {{8, 1e-4}};
  EXPECT_EQ(refusal_of(o).find("optics.zernike_nm: "), 0u) << refusal_of(o);
  o.spread.wavefront = {{8, 100e-9}};
  EXPECT_EQ(refusal_of(o), "");
  o.spread.grid_columns = 3;
  o.spread.field.astigmatism_m = 1e-4;
  EXPECT_EQ(refusal_of(o).find("optics.field_nm: "), 0u) << refusal_of(o);
  o = telescope();
  o.spread.defocus_m = 0.09;
  EXPECT_EQ(refusal_of(o).find("optics.defocus_m: "), 0u) << refusal_of(o);
  o = telescope();
  EXPECT_EQ(refusal_of(o, SensorSeeing{.r0_m = 1e-3, .wind_m_per_s = 0}).find("seeing.r0_m: "), 0u);
  for (const PupilGrid& grid : sample_pupils(o, {{lambda, 1.0}}, plan_psf(o, lambda, {}, 1.0), {}))
    EXPECT_LT(grid.step_m, o.aperture_m / 127);
}

TEST(PsfModel, JitterIsAGaussian) {
  Optics o = telescope();
  const PsfKernel still = kernel_of_camera(o);
  const double nu = 0.2 * o.aperture_m / lambda;
  const double before = otf(o, still, nu);
  o.spread.jitter_rad = 1e-6;
  o.spread.oversampling = plan_psf(telescope(), lambda, {}, 1.0).oversampling;
  EXPECT_NEAR(otf(o, kernel_of_camera(o), nu) / before, jitter_otf(nu, 1e-6), 2e-3);
}

TEST(PsfModel, VanesMakeSpikesAcrossThem) {
  Optics o = telescope();
  o.spread.spiders = 2;  // one bar along x: light spreads along y
  o.spread.spider_width_m = 0.02;
  const PsfKernel k = kernel_of_camera(o);
  double along = 0, across = 0;
  for (int r = 12; r <= 24; ++r) along += k.at(r, 0), across += k.at(0, r);
  EXPECT_GT(across, 2 * along);
}

TEST(PsfModel, ComaIsCentredAndTurnsWithTheField) {
  Optics o = telescope();
  o.spread.grid_columns = 3;
  o.spread.field.coma_m = 80e-9;
  for (double angle : {0.0, 0.5, 2.0}) {
    const PsfKernel k = kernel_of_camera(o, {}, 1.0, {1.0, angle});
    const int cells = plan_psf(o, lambda, {}, 1.0).oversampling;
    EXPECT_NEAR(centroid(k).x_px / cells, 0.0, 0.01) << angle;
    EXPECT_NEAR(centroid(k).y_px / cells, 0.0, 0.01) << angle;
    // The brightest place lies off the centroid along the radius.
    int x = 0, y = 0;
    for (int dy = -k.half; dy <= k.half; ++dy)
      for (int dx = -k.half; dx <= k.half; ++dx)
        if (k.at(dx, dy) > k.at(x, y)) x = dx, y = dy;
    EXPECT_GT(std::abs(x * std::cos(angle) + y * std::sin(angle)), 0.5) << angle;
    EXPECT_LT(std::abs(y * std::cos(angle) - x * std::sin(angle)), 1.0) << angle;
  }
  EXPECT_GT(kernel_of_camera(o).at(0, 0), kernel_of_camera(o, {}, 1.0, {1.0, 0.0}).at(0, 0));
}

// Fried 1966 with von Karman's structure function.
TEST(PsfModel, ALastingExposureIsDiffractionTimesTheLongExposure) {
  Optics o = telescope();
  o.spread.support_px = 200;
  const SensorSeeing seeing{.r0_m = 0.12, .outer_scale_m = 20.0, .wind_m_per_s = 10.0};
  o.spread.oversampling = plan_psf(o, lambda, {}, 1.0).oversampling;
  EXPECT_EQ(plan_psf(o, lambda, seeing, 10.0).exposure, ExposureKind::lasting);
  const PsfKernel k = kernel_of_camera(o, seeing, 10.0);
  for (double share : {0.05, 0.1, 0.2, 0.4}) {
    const double nu = share * o.aperture_m / lambda;
    const double air = std::exp(
        -0.5 * von_karman_structure(nu * lambda, seeing.r0_at_m(lambda), seeing.outer_scale_m));
    EXPECT_NEAR(otf(o, k, nu), diffraction_otf(nu, lambda, o.aperture_m) * air, 0.005) << share;
  }
}

TEST(PsfPlan, TheWidthIsThatOfTheKernelForEveryOuterScale) {
  Optics o = telescope();
  o.spread.support_px = 200;
  o.spread.oversampling = plan_psf(o, lambda, {}, 1.0).oversampling;
  for (const double outer_scale_m : {double(INFINITY), 100.0, 25.0, 5.0, 1.0, 0.2}) {
    const SensorSeeing seeing{.r0_m = 0.1, .outer_scale_m = outer_scale_m};
    const PsfKernel k = kernel_of_camera(o, seeing, 10.0);
    const float half = 0.5f * *std::max_element(k.values.begin(), k.values.end());
    const auto cells =
        std::count_if(k.values.begin(), k.values.end(), [&](float v) { return v > half; });
    const double width_px = std::sqrt(4.0 / pi * double(cells)) / o.spread.oversampling;
    const double exact_to = outer_scale_m >= 20 * seeing.r0_m ? 0.12 : 0.18;
    EXPECT_NEAR(plan_psf(o, lambda, seeing, 10.0).fwhm_px / width_px, 1.0, exact_to)
        << outer_scale_m;
  }
}

// The rungs between: one screen up to tau0, a mean of t / tau0 beyond, the long exposure at last;
// their transfer functions draw near it.
TEST(PsfModel, ExposuresBetweenConvergeToTheLongOne) {
  Optics o = telescope();
  o.spread.max_screens = 1000;
  const SensorSeeing seeing{.r0_m = 0.1, .outer_scale_m = 20.0, .wind_m_per_s = 10.0};
  const double tau0 = seeing.tau0_s(lambda);
  EXPECT_EQ(plan_psf(o, lambda, seeing, 0.9 * tau0).exposure, ExposureKind::brief);
  EXPECT_EQ(plan_psf(o, lambda, seeing, 3.5 * tau0).screens, 4);
  const auto distance = [&](double exposure_s) {
    const PsfKernel k = kernel_of_camera(o, seeing, exposure_s);
    double d = 0;
    for (double share : {0.05, 0.1, 0.15, 0.2, 0.3}) {
      const double nu = share * o.aperture_m / lambda;
      const double air = std::exp(
          -0.5 * von_karman_structure(nu * lambda, seeing.r0_at_m(lambda), seeing.outer_scale_m));
      const double expected = diffraction_otf(nu, lambda, o.aperture_m) * air;
      for (bool along_y : {false, true})
        d = std::max(d, std::abs(otf(o, k, nu, along_y) - expected));
    }
    return d;
  };
  const double one = distance(0.9 * tau0), hundreds = distance(600 * tau0);
  EXPECT_GT(one, 0.1);
  EXPECT_LT(hundreds, 0.05);
}

TEST(PsfModel, ManyWavelengthsAreTheMeanOfTheirKernels) {
  Optics o = telescope();
  o.spread.oversampling = 4;
  o.spread.support_px = 120;
  const std::vector<WavelengthShare> band = {{0.55e-6, 0.5}, {0.49e-6, 0.25}, {0.61e-6, 0.25}};
  const PsfKernel k = kernel_of_camera(o, {}, 1.0, {}, band);
  for (double share : {0.2, 0.5, 0.7}) {
    const double nu = share * o.aperture_m / lambda;
    double expected = 0;
    for (const auto& w : band)
      expected += w.share * diffraction_otf(nu, w.wavelength_m, o.aperture_m);
    double h = 0;
    const double cell_rad = o.pixel_angle_rad() / 4;
    for (int dy = -k.half; dy <= k.half; ++dy)
      for (int dx = -k.half; dx <= k.half; ++dx)
        h += k.at(dx, dy) * std::cos(2 * pi * nu * cell_rad * dx);
    EXPECT_NEAR(h * jitter_otf(nu, grid_sigma_cells * cell_rad), expected, 0.005) << share;
  }
}

// The path through the air does not depend on the wavelength (Roddier 1981, Progress in Optics 19,
// 281): its tilt moves all light of a band alike, however many parts the band is cut into, and
// wherever its centre is among them.
TEST(PsfModel, AnyNumberOfWavelengthsIsMovedByTheSameAir) {
  struct Band {
    double width, off_centre;  // relative to the wavelength
  };
  for (const double aperture_m : {0.4, 1.0})
    for (const double r0_m : {0.08, 0.2})
      for (const Band band : {Band{0.23, 0.0}, Band{0.23, 0.04}, Band{0.8, -0.1}}) {
        Optics o = telescope();
        o.aperture_m = aperture_m;
        o.focal_length_m = 10 * aperture_m;
        o.pixel_pitch_m = 0.4 * lambda / r0_m * o.focal_length_m;  // seeing of 2.5 pixels
        o.spread.support_px = 15;
        const SensorSeeing seeing{.r0_m = r0_m, .wind_m_per_s = 15.0};
        const double exposure_s = 2.5 * seeing.tau0_s(lambda);
        const int oversampling = plan_psf(o, lambda, seeing, exposure_s).oversampling;
        const auto moved = [&](int count) {
          std::vector<WavelengthShare> parts;
          for (int i = 0; i < count; ++i)
            parts.push_back(
                {lambda * (1.0 + band.off_centre + band.width * ((i + 0.5) / count - 0.5)),
                 1.0 / count});
          const PixelPosition at = centroid(kernel_of_camera(o, seeing, exposure_s, {}, parts));
          return PixelPosition{at.x_px / oversampling, at.y_px / oversampling};
        };
        const PixelPosition all = moved(9);
        for (const int count : {1, 2, 5}) {
          const PixelPosition at = moved(count);
          EXPECT_LT(std::hypot(at.x_px - all.x_px, at.y_px - all.y_px), 0.05)
              << count << " wavelengths over " << band.width << ", " << aperture_m << " m, r0 "
              << r0_m << " m, " << band.off_centre;
        }
      }
}

TEST(PsfModel, FromAMillimetreOfSeeingToNoneAtAllKernelsAreFinite) {
  const auto check = [](const Optics& o, double r0_m, double exposure_s) {
    const PsfKernel k =
        kernel_of_camera(o, SensorSeeing{.r0_m = r0_m, .wind_m_per_s = 10.0}, exposure_s);
    EXPECT_NEAR(sum(k), 1.0, 1e-5) << r0_m;
    for (float v : k.values) ASSERT_TRUE(std::isfinite(v)) << r0_m;
  };
  for (double r0_m : {0.001, 0.004, 0.05, 1.0, 1e6}) {
    Optics o = telescope();
    o.spread.support_px = 100;
    o.aperture_m = std::min(0.4, 100 * r0_m);  // D / r0 up to 100
    o.focal_length_m = 10 * o.aperture_m;
    o.pixel_pitch_m = 0.4 * lambda / o.aperture_m * o.focal_length_m;
    check(o, r0_m, 1e-6);
    o.pixel_pitch_m = 0.2 * lambda / std::min(r0_m, o.aperture_m) * o.focal_length_m;
    check(o, r0_m, 1e3);
  }
}

TEST(PsfPlan, ChoosesByTheWidthOfTheBlur) {
  Optics o = telescope();
  EXPECT_EQ(plan_psf(o, lambda, {}, 1.0).method, PointSpread::Method::transform);
  o.pixel_pitch_m = 100e-6;  // an all-sky camera's: lambda / D far below a pixel
  EXPECT_EQ(plan_psf(o, lambda, {}, 1.0).method, PointSpread::Method::deposit);
  o.pixel_pitch_m = 12e-6;
  o.columns = o.rows = 4096;  // would need 280 million cells
  EXPECT_EQ(plan_psf(o, lambda, {}, 1.0).method, PointSpread::Method::direct);
  o.spread.method = PointSpread::Method::deposit;
  EXPECT_THROW(plan_psf(o, lambda, {}, 1.0), ConfigError);
  Optics lens;
  lens.focal_length_m = 0.1, lens.aperture_m = 0.05, lens.pixel_pitch_m = 5e-6;
  lens.columns = lens.rows = 100;
  EXPECT_EQ(plan_psf(lens, lambda, {}, 1.0).method, PointSpread::Method::deposit);
}

}  // namespace
}  // namespace dmise
