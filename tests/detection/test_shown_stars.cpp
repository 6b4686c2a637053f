#include "core/detection/stars/shown_stars.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/detection/pixels/components.h"
#include "tests/support/simulated_frame.h"
#include "tests/support/simulated_scene.h"

namespace dmise {
namespace {

using simulated::camera_header;
using simulated::SimulatedFrame;
using simulated::SimulatedScene;

constexpr int size = 400;
constexpr double sky_e = 1500.0, flux_e = 8000.0;  // an SNR of 70

/// A frame whose stars are 0.2 px and 15 % beside what is expected, with a fainter one 3 px from
/// each second of them.
struct Shown {
  FrameHeader header = camera_header(size, size, 1663, 0.6, 2.0, false);
  std::vector<ExpectedStar> expected, truth;
  std::vector<ShownStar> stars;

  Shown() {
    SimulatedFrame frame(header, size, size, sky_e, 7);
    std::mt19937_64 random(3);
    std::normal_distribution<double> normal;
    for (int i = 0; i < 100; ++i) {
      const ExpectedStar star{
          {40.0 + 35 * (i % 10) + normal(random), 40.0 + 35 * double(i / 10) + normal(random)},
          flux_e};
      add(star, normal, random, frame);
      if (i % 2 == 0)
        add({{star.place.x_px + 3, star.place.y_px}, 0.3 * flux_e}, normal, random, frame);
    }
    SimulatedScene exposed(header, frame.expose());
    const Scene& scene = exposed.scene;
    FilteredFrame filtered(size, size, scene.sigma_px);
    find_components(scene.counts, scene.background, scene.sigma_px, 3.0, 5.0, exposed.one,
                    &filtered);
    stars = shown_stars(scene, StarAgreement(scene, filtered, expected), expected);
  }
  void add(const ExpectedStar& star, std::normal_distribution<double>& normal,
           std::mt19937_64& random, SimulatedFrame& frame) {
    expected.push_back(star);
    truth.push_back(
        {{star.place.x_px + 0.2 * normal(random), star.place.y_px + 0.2 * normal(random)},
         star.signal_e * std::exp(0.15 * normal(random))});
    frame.add_point(truth.back().place.x_px, truth.back().place.y_px, truth.back().signal_e);
  }
};

TEST(ShownStars, HaveTheirOwnPlaceAndLight) {
  const Shown shown;
  ASSERT_EQ(shown.stars.size(), shown.truth.size());
  double apart = 0.0, light = 0.0;
  for (std::size_t i = 0; i < shown.stars.size(); ++i) {
    const ShownStar& star = shown.stars[i];
    const ExpectedStar& truth = shown.truth[i];
    apart += std::pow(
        std::hypot(star.trail.x_px - truth.place.x_px, star.trail.y_px - truth.place.y_px), 2);
    light += std::pow(star.flux_e / truth.signal_e - 1, 2);
  }
  const auto n = double(shown.stars.size());
  EXPECT_LT(std::sqrt(apart / n), 0.12);  // 0.28 as expected
  EXPECT_LT(std::sqrt(light / n), 0.06);  // 0.15 as expected
}

TEST(ShownStars, KnowTheirErrors) {
  Shown shown;
  const ShownStar& star = shown.stars[0];
  EXPECT_LT(star.light_error, 0.06);
  EXPECT_GT(star.noise_e, std::sqrt(sky_e));
}

}  // namespace
}  // namespace dmise
