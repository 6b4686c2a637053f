#include "tests/projection/every_pixel.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "core/base/units.h"
#include "core/optics/projection.h"
#include "tests/support/data.h"

namespace dmise::test {

Optics camera_of(const Projection& projection, double field_deg, int columns, int rows) {
  constexpr double pitch_m = 5e-6;
  return {.projection = projection,
          .focal_length_m = 0.5 * columns * pitch_m / projection.height(0.5 * field_deg * deg),
          .aperture_m = 1e-4,
          .pixel_pitch_m = pitch_m,
          .columns = columns,
          .rows = rows};
}

void expect_one_to_one_at_every_pixel(const Optics& optics) {
  ASSERT_FALSE(fold_in_frame_rad(optics));
  constexpr double min_z = -0.8;  // beyond, directions turn too fast for differences
  const double f = optics.focal_length_px(), step_px = std::min(0.5, 1e-4 * f);
  double worst_px = 0.0, worst_rad = 0.0, worst_sr = 0.0;
  int seen = 0;
  for (int y = 0; y < optics.rows; ++y)
    for (int x = 0; x < optics.columns; ++x) {
      const PixelPosition pixel{double(x), double(y)};
      const auto direction = unproject(optics, pixel);
      if (!direction) continue;
      ++seen;
      const auto back = project(optics, *direction);
      ASSERT_TRUE(back) << x << " " << y;
      worst_px = std::max(worst_px, std::hypot(back->x_px - x, back->y_px - y) / f);
      const auto again = unproject(optics, *back);
      ASSERT_TRUE(again) << x << " " << y;
      worst_rad = std::max(worst_rad, angle_rad(*again, *direction));
      if (direction->z < min_z) continue;
      const auto left = unproject(optics, {x - step_px, double(y)}),
                 right = unproject(optics, {x + step_px, double(y)}),
                 above = unproject(optics, {double(x), y - step_px}),
                 below = unproject(optics, {double(x), y + step_px});
      if (!left || !right || !above || !below) continue;
      const double sr = norm(cross(*right - *left, *below - *above)) / (4 * step_px * step_px);
      worst_sr = std::max(worst_sr, std::abs(sr / pixel_solid_angle_sr(optics, pixel) - 1));
    }
  EXPECT_GT(seen, optics.columns * optics.rows / 4) << optics.projection.name();
  EXPECT_LT(worst_px, 1e-9) << optics.projection.name();
  EXPECT_LT(worst_rad, 1e-9) << optics.projection.name();
  EXPECT_LT(worst_sr, 1e-5) << optics.projection.name();
}

std::vector<PixelPosition> places_by_opencv(const std::string& model,
                                            const std::vector<double>& coefficients,
                                            const std::vector<Vec<CameraFrame>>& directions) {
  const std::string file = testing::TempDir() + "/opencv.txt";
  std::ofstream lines(file);
  lines.precision(17);
  for (const double c : coefficients) lines << c << " ";
  lines << "\n";
  for (const auto& d : directions) lines << d.x << " " << d.y << " " << d.z << "\n";
  lines.close();
  const std::string command = "/usr/bin/python3 " DMISE_SOURCE_DIR
                              "/tests/reference/project_with_opencv.py " +
                              model + " " + file;
  std::vector<PixelPosition> places;
  FILE* pipe = popen(command.c_str(), "r");
  for (PixelPosition p; std::fscanf(pipe, "%lf %lf", &p.x_px, &p.y_px) == 2;) places.push_back(p);
  pclose(pipe);
  std::filesystem::remove(file);
  return places;
}

void expect_as_opencv(const Projection& projection, const std::string& model,
                      const std::vector<double>& coefficients, double max_rad) {
  if (std::system("/usr/bin/python3 -c 'import cv2' 2> /dev/null") != 0)
    DMISE_SKIP() << "needs python3-opencv";
  std::vector<Vec<CameraFrame>> directions;
  for (int i = 0; i <= 60; ++i)
    for (int k = 0; k < 12; ++k) {
      const double theta = max_rad * i / 60, phi = 2 * pi * k / 12 + 0.1;
      directions.push_back(
          {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)});
    }
  const auto wanted = places_by_opencv(model, coefficients, directions);
  ASSERT_EQ(wanted.size(), directions.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const auto& d = directions[i];
    const auto place = projection.image_of(d.x, d.y, d.z);
    ASSERT_TRUE(place) << i;
    const double far = std::max(1e-3, std::hypot(wanted[i].x_px, wanted[i].y_px));
    EXPECT_NEAR((*place)[0], wanted[i].x_px, 1e-9 * far) << i;
    EXPECT_NEAR((*place)[1], wanted[i].y_px, 1e-9 * far) << i;
    const auto back = projection.direction_of(wanted[i].x_px, wanted[i].y_px);
    ASSERT_TRUE(back) << i;
    EXPECT_LT(angle_rad(Vec<CameraFrame>{(*back)[0], (*back)[1], (*back)[2]}, d), 1e-9) << i;
  }
}

}  // namespace dmise::test
