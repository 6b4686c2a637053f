#include "sensors/light/star_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "core/base/units.h"
#include "core/optics/projection.h"

namespace dmise {
namespace {

std::vector<Vec<Gcrs>> all_over_the_sky(std::size_t count) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  std::vector<Vec<Gcrs>> directions;
  for (std::size_t i = 0; i < count; ++i)
    directions.push_back(unit(Vec<Gcrs>{normal(random), normal(random), normal(random)}));
  return directions;
}

Optics lens(const Projection& projection, double focal_length_px) {
  Optics optics;
  optics.projection = projection;
  optics.columns = 1600;
  optics.rows = 1200;
  optics.pixel_pitch_m = 1e-5;
  optics.focal_length_m = focal_length_px * optics.pixel_pitch_m;
  return optics;
}

// Reference: each star's own pixel by the camera's projection, and its angle from the frame.
TEST(StarOrder, LeavesOutNoneThatIsNearTheFrame) {
  const Column<Vec<Gcrs>> directions(all_over_the_sky(40000));
  constexpr double beside_rad = 1.5 * deg;
  for (const Optics& optics :
       {lens(Projection::gnomonic, 800), lens(Projection::gnomonic, 12000),
        lens(Projection::gnomonic, 200), lens(Projection::equidistant, 500),
        lens(Projection::equidistant, 300), lens(Projection::stereographic, 700),
        lens(Projection::equisolid, 400)}) {
    std::vector<std::uint32_t> stars(directions.size());
    std::iota(stars.begin(), stars.end(), 0U);
    const Rotation<CameraFrame, Gcrs> camera;
    order_for_drawing(stars, directions, camera, optics, beside_rad);
    std::vector<bool> is_there(directions.size(), false);
    for (const std::uint32_t star : stars) {
      EXPECT_FALSE(is_there[star]);
      is_there[star] = true;
    }
    std::mt19937 random(2);
    std::uniform_real_distribution<double> turn(-beside_rad / 2, beside_rad / 2);
    int in_frame = 0;
    for (std::size_t i = 0; i < directions.size(); ++i) {
      // Wherever it is moved to by less.
      const Vec<CameraFrame> at = camera * directions[i];
      for (int k = 0; k < 4; ++k) {
        const auto pixel =
            project(optics, at + Vec<CameraFrame>{turn(random), turn(random), turn(random)});
        if (!pixel || pixel->x_px < -0.5 || pixel->x_px > optics.columns - 0.5 ||
            pixel->y_px < -0.5 || pixel->y_px > optics.rows - 0.5)
          continue;
        EXPECT_TRUE(is_there[i]) << i;
        ++in_frame;
      }
    }
    EXPECT_GT(in_frame, 3);
    if (optics.focal_length_px() > 600) {
      EXPECT_LT(stars.size(), directions.size() / 3);
    }
  }
}

TEST(StarOrder, IsTheSameEachTimeAndTakesNone) {
  const Column<Vec<Gcrs>> directions(all_over_the_sky(5000));
  const Optics optics = lens(Projection::gnomonic, 800);
  std::vector<std::uint32_t> none, stars(directions.size());
  order_for_drawing(none, directions, {}, optics, 0.02);
  EXPECT_TRUE(none.empty());
  std::iota(stars.begin(), stars.end(), 0U);
  std::vector<std::uint32_t> again = stars;
  order_for_drawing(stars, directions, {}, optics, 0.02);
  order_for_drawing(again, directions, {}, optics, 0.02);
  EXPECT_EQ(stars, again);
}

}  // namespace
}  // namespace dmise
