#include "core/sky/sky_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/base/units.h"
#include "core/photometry/magnitude.h"
#include "core/sky/air/extinction.h"
#include "core/sky/sky_model.h"

namespace dmise {
namespace {

double worst_error(int columns, int rows, const PixelFunction& f,
                   std::size_t* evaluations = nullptr) {
  std::vector<float> image(std::size_t(columns) * std::size_t(rows), -1.0F);
  Threads one(1);
  const std::size_t made = fill_from_grid(columns, rows, f, 0.005, image.data(), one);
  if (evaluations) *evaluations = made;
  double worst = 0.0;
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      const double exact = f(x, y);
      worst = std::max(worst, std::abs(image[std::size_t(y) * columns + x] - exact) / exact);
    }
  return worst;
}

/// An equidistant fisheye with the zenith in its middle and the horizon inside the frame.
Vec<Enu> fisheye(double x, double y, int columns, int rows, double px_per_rad) {
  const double u = x - (columns - 1) / 2.0, v = y - (rows - 1) / 2.0;
  const double from_zenith = std::hypot(u, v) / px_per_rad, angle = std::atan2(v, u);
  const double s = std::sin(from_zenith);
  return {s * std::cos(angle), s * std::sin(angle), std::cos(from_zenith)};
}

TEST(SkyGrid, OddSizesAreFilledWhole) {
  const PixelFunction f = [](double x, double y) {
    return 2 + std::sin(x / 300) * std::cos(y / 200);
  };
  for (const auto& [columns, rows] :
       {std::pair{1, 1}, {1, 40}, {2, 2}, {33, 32}, {34, 65}, {503, 329}})
    EXPECT_LT(worst_error(columns, rows, f), 0.005) << columns << " x " << rows;
}

TEST(SkyGrid, AnEdgeIsFollowedDownToPixels) {
  const PixelFunction f = [](double x, double y) { return x + 0.3 * y > 60 ? 2.0 : 1.0; };
  EXPECT_LT(worst_error(160, 120, f), 0.005);
}

TEST(SkyGrid, AllPartsOnAnAllSkyFrameWithTheMoonInItAreWithinHalfAPercent) {
  SkyScene scene;
  scene.moon = from_spherical<Enu>(1.0, 35 * deg);
  scene.moon_phase_rad = 0.4;
  scene.sun = from_spherical<Enu>(2.5, -10 * deg);
  SkyParts parts = sky_parts_named("dark").value();
  parts.light_pollution.emplace();
  parts.light_pollution->zenith_v_mag_per_arcsec2 = 20.5;
  parts.light_pollution->cities.push_back({.azimuth_rad = 0.3});
  const SkyModel sky(parts, scene, johnson_v(), *extinction_of_site("lick"));
  std::size_t evaluations = 0;
  const PixelFunction f = [&](double x, double y) {
    return sky.photons_per_s_m2_sr(fisheye(x, y, 1001, 753, 300));
  };
  EXPECT_LT(worst_error(1001, 753, f, &evaluations), 0.005);
  EXPECT_LT(evaluations, 1001u * 753u / 4);
}

}  // namespace
}  // namespace dmise
