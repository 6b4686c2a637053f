#include "tests/detection/hard_expectations.h"

// Streaks beside hard stars: none, one, saturated ones, their overflow.
namespace dmise::simulated {
namespace {

TEST(HardStars, WithoutAStarAStreakAndAPointAreFound) {
  HardFrame scene(800, 700, 1);
  scene.frame.add_point(500.3, 420.6, 9000);
  add_three_streaks(scene);
  const auto result = scene.detected();
  ASSERT_EQ(result.detections.size(), 4u);
  const auto point = std::find_if(result.detections.begin(), result.detections.end(),
                                  [](const Detection& d) { return d.length_px == 0; });
  ASSERT_NE(point, result.detections.end());
  EXPECT_NEAR(point->x_px, 500.3, 0.2);
  EXPECT_NEAR(point->y_px, 420.6, 0.2);
  EXPECT_EQ(result.report.star_like, 0u);
}

TEST(HardStars, OneStarIsNoDetection) {
  HardFrame scene(800, 700, 2);
  add_three_streaks(scene);
  scene.frame.add_star(450, 350, 40000);
  expect_streaks_alone(scene);
}

TEST(HardStars, OneStarAloneGivesNothing) {
  for (const double flux_e : {3e3, 1e5, 1e7}) {
    HardFrame scene(400, 300, 3);
    scene.frame.add_star(200.3, 150.4, flux_e);
    expect_streaks_alone(scene);
  }
}

// Peaks of 9 to 270 times the full well.
TEST(HardStars, AllSaturatedGiveNothing) {
  for (const double flux_e : {1e6, 3e7}) {
    HardFrame scene(800, 700, 4);
    add_three_streaks(scene);
    scene.add_stars(300, flux_e, 20);
    expect_streaks_alone(scene);
  }
}

TEST(HardStars, AllSaturatedAndBloomingGiveNothing) {
  HardFrame scene(800, 700, 5);
  add_three_streaks(scene);
  scene.add_stars(60, 1e6, 60);
  scene.bloom();
  expect_streaks_alone(scene);
}

TEST(HardStars, AStreakThroughASaturatedStarIsOneStreak) {
  HardFrame scene(600, 600, 6);
  scene.add(300, 300, 300, 0.5);
  scene.frame.add_star(300, 300, 1e6);
  expect_streaks_alone(scene, {.flux = 0.08});
}

// 100 px of the star's column and its neighbours are full.
TEST(HardStars, AStreakAcrossABleedColumnIsOneStreak) {
  HardFrame scene(600, 600, 7);
  scene.add(300, 330, 240, 0.3);
  scene.frame.add_star(300, 300, 6e6);
  scene.bloom();
  expect_streaks_alone(scene, {.flux = 0.08});
}

// The streak begins in the overflow and leaves it: its upper half is visible.
TEST(HardStars, AStreakAlongABleedColumnIsFound) {
  HardFrame scene(500, 900, 8);
  scene.add(250, 600, 400, pi / 2);
  scene.frame.add_star(250, 300, 8e6);
  scene.bloom();
  const auto result = scene.detected();
  ASSERT_EQ(result.detections.size(), 1u);
  const Detection& d = result.detections[0];
  EXPECT_LT(std::abs(scene.streaks[0].across({d.x_px, d.y_px})), 1.0);
  EXPECT_NEAR(std::max(d.end1_y_px, d.end2_y_px), 800, 2);
}

}  // namespace
}  // namespace dmise::simulated
