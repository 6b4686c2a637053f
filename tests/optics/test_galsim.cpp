#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"
#include "core/optics/blur/blur_grid.h"
#include "core/optics/psf_model.h"

// GalSim's tables, made by tests/reference/galsim_psf.py.
#include "tests/reference/galsim_psf.inc"

// One star in the middle of a pixel on the way that frames take: deposited on cells, transformed
// with the camera's kernel, summed to pixels.
namespace dmise {
namespace {

constexpr double lambda = 0.55e-6, diameter = 0.3, r0 = 0.1;
constexpr int half = 10, side = 2 * half + 1;

struct Star {
  ExpectedElectronImage image;  // 101 x 101, the star in the middle; unit light
  double beyond;                // light beyond the kernel, which it gives back to the rest

  double at(int dx, int dy) const { return double(image.at(50 + dx, 50 + dy)) * (1 - beyond); }
};

Optics telescope(double aperture_m, double pixel_rad) {
  Optics o{.focal_length_m = 10 * aperture_m,
           .aperture_m = aperture_m,
           .pixel_pitch_m = 10 * aperture_m * pixel_rad,
           .columns = 101,
           .rows = 101};
  o.spread.model = PointSpread::Model::diffraction;
  o.spread.method = PointSpread::Method::transform;
  o.spread.support_px = 512;
  return o;
}

Star star(const Optics& o, const std::optional<SensorSeeing>& seeing = {}) {
  Threads one(1);
  const PsfPlan plan = plan_psf(o, lambda, seeing, 1e3);
  PsfModel model(o, {{lambda, 1.0}}, plan, seeing, rng_key(1, "s", 0, "turbulence"));
  BlurGrid grid(o.columns, o.rows, plan.oversampling, plan.half_cells);
  grid.set_kernels({model.kernel({}, 0.0, 1e3)}, one);
  const Arc on_cells = grid.on_cells({{50, 50}, {50, 50}, {50, 50}, 1.0});
  deposit({&on_cells, 1}, make_psf_table(grid_sigma_cells), grid.cells(), one);
  Star s{ExpectedElectronImage(o.columns, o.rows),
         plan.exposure == ExposureKind::lasting ? 0.0 : plan.beyond};
  grid.blur_into(s.image, o.spread.resampling, one);
  return s;
}

void expect_agreement(const Star& s, const double* reference) {
  const double peak = reference[half * side + half];
  for (int y = -half; y <= half; ++y)
    for (int x = -half; x <= half; ++x)
      EXPECT_NEAR(s.at(x, y), reference[(y + half) * side + x + half], 1e-3 * peak)
          << x << " " << y;
}

TEST(FrameAgainstGalSim, OfAClearAperture) {
  expect_agreement(star(telescope(diameter, 0.5 * lambda / diameter)), galsim_airy);
}

TEST(FrameAgainstGalSim, OfAnObscuredAperture) {
  Optics o = telescope(diameter, 0.5 * lambda / diameter);
  o.obscuration = 0.4;
  expect_agreement(star(o), galsim_obscured_airy);
}

TEST(FrameAgainstGalSim, OfALongExposure) {
  // An aperture so large that turbulence alone blurs.
  const SensorSeeing seeing{.r0_m = r0 * std::pow(0.5e-6 / lambda, 1.2), .wind_m_per_s = 10.0};
  expect_agreement(star(telescope(100, 0.325 * lambda / r0), seeing), galsim_kolmogorov);
}

// Born & Wolf: first zero at 1.2197 lambda/D with 83.8 % of the light inside, 91.0 % within the
// second at 2.2331. Pixels cut by the circle count by the share of 16 x 16 points inside.
TEST(Frame, OfAClearApertureIsTheAiryPattern) {
  constexpr double pixel = 0.1;  // in lambda / D
  const Star s = star(telescope(diameter, pixel * lambda / diameter));
  const auto encircled = [&](double radius_px) {
    double sum = 0;
    for (int y = -49; y <= 49; ++y)
      for (int x = -49; x <= 49; ++x) {
        int inside = 0;
        for (int j = 0; j < 16; ++j)
          for (int i = 0; i < 16; ++i)
            inside += std::hypot(x + (i + 0.5) / 16 - 0.5, y + (j + 0.5) / 16 - 0.5) <= radius_px;
        sum += s.at(x, y) * inside / 256;
      }
    return sum;
  };
  EXPECT_NEAR(encircled(1.2197 / pixel), 0.838, 0.002);
  EXPECT_NEAR(encircled(2.2331 / pixel), 0.910, 0.002);
  int darkest = 1;
  for (int x = 1; x < 20; ++x)
    if (s.at(x, 0) < s.at(darkest, 0)) darkest = x;
  EXPECT_NEAR(darkest * pixel, 1.2197, 0.05);
  // The peak, pi/4 (D/lambda)^2 a steradian, less what a pixel's breadth costs: 0.4 %.
  EXPECT_NEAR(s.at(0, 0) / (pi / 4 * pixel * pixel), 1.0, 6e-3);
}

}  // namespace
}  // namespace dmise
