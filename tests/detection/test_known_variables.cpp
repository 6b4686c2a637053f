#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "core/detection/detect.h"
#include "core/sky/variables/variable_stars.h"
#include "core/wcs/wcs.h"
#include "tests/support/simulated_frame.h"

// Detection with a catalogue whose stars vary: none of them is a satellite, however bright it is.
namespace dmise {
namespace {

using simulated::camera_header;
using simulated::SimulatedFrame;

constexpr double sky_level_e = 1500.0, seconds = 2.0;
constexpr int width_px = 700, height_px = 600;

/// Constant stars around ten that vary by 3 mag both ways about V = 5.7, and about 8.7: those are
/// too faint to be found.
class KnownVariables : public testing::Test {
 protected:
  KnownVariables() {
    header_.zero_point_mag = 8.0 + 2.5 * std::log10(650.0 / seconds);
    StarCatalogue stars;
    SimulatedFrame random(header_, width_px, height_px, sky_level_e, 7);
    const auto add = [&](PixelPosition at, double v_mag) {
      const auto place = to_spherical(wcs_direction(header_.wcs, at));
      append_star(stars, {.id = std::uint32_t(stars.size() + 1),
                          .ra_rad = place[0],
                          .dec_rad = place[1],
                          .v_mag = v_mag,
                          .bv = 0.65});
      return place;
    };
    for (int i = 0; i < 10; ++i) {
      const PixelPosition at{90.0 + 130 * (i % 5), 150.0 + 300 * (i / 5)};
      const double mean_v_mag = i < 5 ? 5.7 : 8.75, half_range_mag = i < 5 ? 3.0 : 5.45;
      const auto place = add(at, mean_v_mag);
      variable_at_.push_back(at);
      reading_.stars.push_back({.name = "V" + std::to_string(i),
                                .type = "M",
                                .ra_rad = place[0],
                                .dec_rad = place[1],
                                .brightest_mag = mean_v_mag - half_range_mag,
                                .depth_mag = 2 * half_range_mag,
                                .second_depth_mag = {},
                                .band = "V",
                                .epoch_hjd = 2450000.0,
                                .period_d = 300.0,
                                .share_of_period = 0.5});
    }
    for (int i = 0; i < 1000; ++i) {
      const PixelPosition at{random.uniform(-10, width_px + 10),
                             random.uniform(-10, height_px + 10)};
      bool clear = true;
      for (const PixelPosition& v : variable_at_)
        clear = clear && std::hypot(v.x_px - at.x_px, v.y_px - at.y_px) > 25;
      if (clear) add(at, 9.0 + std::log(random.uniform(1e-3, 1.0)) / std::log(3.0));
    }
    constant_ = std::make_shared<const StarMap>(star_map_of(std::move(stars)));
    auto map = std::make_shared<StarMap>(*constant_);
    map->variables = std::make_shared<const VariableStars>(*constant_, reading_);
    variable_ = map;
  }

  /// The stars, the ten by so much of half their range fainter than their mean.
  CountImage drawn(double fainter, unsigned seed) {
    SimulatedFrame frame(header_, width_px, height_px, sky_level_e, seed);
    for (const ExpectedStar& star :
         CatalogueSky(constant_).stars_in(header_, width_px, height_px, 5.0)) {
      const bool varies = std::ranges::any_of(variable_at_, [&](const PixelPosition& v) {
        return std::hypot(v.x_px - star.place.x_px, v.y_px - star.place.y_px) < 0.5;
      });
      const double ratio = varies ? std::pow(10.0, -0.4 * fainter * half_range_mag(star)) : 1.0;
      frame.add_point(star.place.x_px, star.place.y_px, ratio * star.signal_e);
    }
    return frame.expose();
  }
  static double half_range_mag(const ExpectedStar& star) {
    return star.place.y_px < 300 ? 3.0 : 5.45;
  }
  DetectionResult detected(const CountImage& counts, const std::shared_ptr<const StarMap>& map) {
    const CatalogueSky sky(map);
    return detect(counts, header_, {}, threads_, &sky);
  }

  FrameHeader header_ = camera_header(width_px, height_px, 1663, 0.6, seconds, false);
  std::vector<PixelPosition> variable_at_;
  VariableReading reading_;
  std::shared_ptr<const StarMap> constant_, variable_;
  Threads threads_{2};
};

TEST_F(KnownVariables, AreExpectedWithTheirRange) {
  int varying = 0;
  for (const ExpectedStar& star :
       CatalogueSky(variable_).stars_in(header_, width_px, height_px, 5.0)) {
    varying += star.varies();
    if (!star.varies()) continue;
    const double v_mag = star.place.y_px < 300 ? 5.7 : 8.75;
    const double mean_e = seconds * std::pow(10.0, 0.4 * (header_.zero_point_mag - v_mag));
    EXPECT_NEAR(star.signal_e, mean_e, 1e-3 * mean_e);
    EXPECT_NEAR(star.most, std::pow(10.0, 0.4 * half_range_mag(star)), 1e-3 * star.most);
    EXPECT_NEAR(star.least, std::pow(10.0, -0.4 * half_range_mag(star)), 1e-3);
  }
  EXPECT_EQ(varying, 10);
}

TEST_F(KnownVariables, AreNoDetectionsAtAnyMagnitude) {
  unsigned seed = 1;
  for (const double fainter : {-1.0, -0.7, -0.4, -0.2, 0.0, 0.3, 0.6, 1.0, 5.0}) {
    const DetectionResult result = detected(drawn(fainter, ++seed), variable_);
    EXPECT_TRUE(result.detections.empty()) << fainter << ": " << result.detections.size();
    EXPECT_TRUE(result.stars.agree()) << fainter;
  }
}

// What the range is for: a catalogue of constant stars takes those that are bright for satellites.
TEST_F(KnownVariables, WouldBeDetectionsWithoutTheirRange) {
  EXPECT_GE(detected(drawn(-1.0, 20), constant_).detections.size(), 3u);
}

// A satellite beside them is found as beside constant stars, also while they are faint.
TEST_F(KnownVariables, LeaveSatellitesBesideThem) {
  for (const double fainter : {-0.2, 0.0, 1.0}) {
    SimulatedFrame frame(header_, width_px, height_px, sky_level_e, 31);
    for (const ExpectedStar& star :
         CatalogueSky(variable_).stars_in(header_, width_px, height_px, 5.0))
      frame.add_point(
          star.place.x_px, star.place.y_px,
          star.signal_e *
              (star.varies() ? std::pow(10.0, -0.4 * fainter * half_range_mag(star)) : 1.0));
    for (const PixelPosition& at : variable_at_) frame.add_point(at.x_px + 14, at.y_px + 8, 4000);
    int found = 0;
    for (const Detection& d : detected(frame.expose(), variable_).detections)
      found += std::ranges::any_of(variable_at_, [&](const PixelPosition& at) {
        return std::hypot(d.x_px - at.x_px - 14, d.y_px - at.y_px - 8) < 1.0;
      });
    EXPECT_GE(found, 8) << fainter;
  }
}

}  // namespace
}  // namespace dmise
