#include "core/astrometry/plate_model.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"
#include "tests/astrometry/seen_plate.h"

namespace dmise {
namespace {

PlateModel bent_model() {
  PlateModel m{.projection = Projection::gnomonic,
               .camera_from_gcrs = test::pointing(0.1, 89.7, 40),
               .focal_length_px = 3000,
               .centre = {1000, 700},
               .order = 3,
               .unit_px = 1250};
  m.distortion.assign(std::size_t(distortion_size(3)), 0.0);
  for (std::size_t i = 0; i < m.distortion.size(); ++i) m.distortion[i] = 6 * std::cos(double(i));
  return m;
}

TEST(PlateModel, PixelAndDirectionAreInverseThroughADistortionNearAPole) {
  const PlateModel m = bent_model();
  for (double y = 0; y < 1400; y += 199)
    for (double x = 0; x < 2000; x += 199) {
      const auto direction = m.direction({x, y});
      ASSERT_TRUE(direction);
      const auto back = m.pixel(*direction);
      ASSERT_TRUE(back);
      EXPECT_NEAR(back->x_px, x, 1e-5);
      EXPECT_NEAR(back->y_px, y, 1e-5);
    }
}

// The gnomonic projection: the tangent of the angle from the axis, away from it.
TEST(PlateModel, ImagesTheTangentOfTheAngle) {
  PlateModel m{.projection = Projection::gnomonic,
               .camera_from_gcrs = test::pointing(30, 0, 0),
               .focal_length_px = 1000};
  const auto west = m.pixel(from_spherical<Gcrs>(20 * deg, 0));
  const auto south = m.pixel(from_spherical<Gcrs>(30 * deg, -10 * deg));
  ASSERT_TRUE(west && south);
  EXPECT_NEAR(west->x_px, 1000 * std::tan(10 * deg), 1e-9);
  EXPECT_NEAR(west->y_px, 0, 1e-9);
  EXPECT_NEAR(south->x_px, 0, 1e-9);
  EXPECT_NEAR(south->y_px, 1000 * std::tan(10 * deg), 1e-9);
  EXPECT_FALSE(m.mirrored());
  m.camera_from_gcrs = flipped(m.camera_from_gcrs);
  EXPECT_TRUE(m.mirrored());
  EXPECT_NEAR(m.pixel(from_spherical<Gcrs>(30 * deg, -10 * deg))->y_px, -1000 * std::tan(10 * deg),
              1e-9);
}

TEST(PlateModel, CountsTheTermsOfADistortion) {
  for (int order = 0; order <= 6; ++order) {
    std::vector<PixelPosition> moves;
    distortion_terms(order, 0.3, -0.7, moves);
    EXPECT_EQ(int(moves.size()), distortion_size(order));
  }
}

}  // namespace
}  // namespace dmise
