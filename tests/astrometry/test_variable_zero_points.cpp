#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "core/astrometry/solve_frame.h"
#include "core/detection/known/catalogue_sky.h"
#include "core/sky/stars/star_cache.h"
#include "core/sky/variables/variable_stars.h"
#include "tests/support/data.h"
#include "tests/support/simulated_frame.h"

namespace dmise {
namespace {

/// A field of the catalogue in which three stars of five vary, all of which are 0.5 mag fainter.
class VariableZeroPoints : public testing::Test {
 protected:
  static constexpr int width_px = 1200, height_px = 1000;
  static constexpr double fainter_mag = 0.5;

  VariableZeroPoints() {
    header_.zero_point_mag = 17.5;
    header_.sensor_position_m = {7e6, 0, 0};
    header_.sensor_velocity_m_per_s = {0, 7.5e3, 0};
    const StarTable& stars = constant_->stars;
    const ExpectedStars expected(header_, width_px, height_px, 10.0, 20.0);
    VariableReading reading;
    for (std::size_t i = 0; i < stars.size(); ++i) {
      const auto star = expected.at(constant_->index.direction[i], stars.v_mag[i], stars.colour(i));
      if (!star) continue;
      const bool varies = i % 5 < 3;
      drawn_.push_back({*star, varies});
      if (!varies) continue;
      reading.stars.push_back({.name = "V",
                               .type = "LB",
                               .ra_rad = stars.ra_rad[i],
                               .dec_rad = stars.dec_rad[i],
                               .brightest_mag = stars.v_mag[i],
                               .depth_mag = 2 * fainter_mag,
                               .second_depth_mag = {},
                               .band = "V",
                               .epoch_hjd = {},
                               .period_d = {},
                               .share_of_period = {}});
    }
    auto map = std::make_shared<StarMap>(*constant_);
    map->variables = std::make_shared<const VariableStars>(*constant_, reading);
    variable_ = map;
  }

  double zero_point_mag(double by_mag, const StarMap& map) {
    simulated::SimulatedFrame image(header_, width_px, height_px, 100, 3);
    for (const auto& [star, varies] : drawn_)
      image.add_point(star.place.x_px, star.place.y_px,
                      star.signal_e * (varies ? std::pow(10.0, -0.4 * by_mag) : 1.0));
    const Frame frame{image.expose(), header_};
    const FrameSolution solution = solve_frame(frame, map, {}, threads_);
    return solution.zero_point ? solution.zero_point->zero_point_mag : std::nan("");
  }

  FrameHeader header_ = simulated::camera_header(width_px, height_px, 4000.0, 0.4, 4.0, false, 1.3);
  std::shared_ptr<const StarMap> constant_ =
      std::make_shared<const StarMap>(load_star_map(test::catalogue_path("stars.dat.gz")));
  std::shared_ptr<const StarMap> variable_;
  std::vector<std::pair<ExpectedStar, bool>> drawn_;
  Threads threads_{2};
};

// Measured without them, a zero point is that of the other stars, whatever the variables do.
TEST_F(VariableZeroPoints, AreThoseOfTheOtherStars) {
  const double right_mag = zero_point_mag(0.0, *constant_);
  EXPECT_NEAR(zero_point_mag(fainter_mag, *variable_), right_mag, 0.01);
  EXPECT_GT(std::abs(zero_point_mag(fainter_mag, *constant_) - right_mag), 0.03);
}

}  // namespace
}  // namespace dmise
