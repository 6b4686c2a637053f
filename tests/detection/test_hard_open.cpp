#include "tests/detection/hard_expectations.h"

// Expectations that were met last.
namespace dmise::simulated {
namespace {

// One crosses the other within 4 px of its own middle.
TEST(HardOpen, TwoThatCrossInTheMiddleAreTwo) {
  HardFrame scene(600, 600, 1);
  scene.add(300, 300, 300, 0.4);
  scene.add({301, 301, 250, 1.4, 250 * 400.0});
  expect_streaks_alone(scene, {.flux = 0.08});
}

TEST(HardOpen, SixThatCrossAreSix) {
  HardFrame scene(1000, 1000, 3);
  for (int i = 0; i < 6; ++i)
    scene.add(500 + 60 * std::sin(7.0 * i), 500 + 60 * std::cos(5.0 * i), 600, pi * i / 6);
  expect_streaks_alone(scene, {.flux = 0.1});
}

TEST(HardOpen, TwoParallelOnesThreePixelsApartAreTwo) {
  for (const double angle : {0.0, 0.4, 1.2}) {
    HardFrame scene(600, 600, 2);
    add_pair(scene, 3, angle);
    expect_streaks_alone(scene, {.flux = 0.1});
  }
}

TEST(HardOpen, ATrainOnOneLineIsTen) {
  for (const double piece_px : {20.0, 28.0, 60.0})
    for (const double gap_px : {12.0, 20.0, 26.0}) {
      HardFrame scene(1000, 600, 4);
      add_row(scene, {60, 60}, 10, piece_px, gap_px);
      expect_streaks_alone(scene, {.flux = 0.1});
    }
}

// As bright as two, with the shape of neither: 4 px, over which the light is even.
TEST(HardOpen, AWideBodyIsOne) {
  for (const double angle : {0.0, 0.4, 1.2}) {
    HardFrame scene(600, 600, 2);
    for (int i = -8; i <= 8; ++i)
      scene.frame.add_streak(300 - 0.25 * i * std::sin(angle), 300 + 0.25 * i * std::cos(angle),
                             200, angle, 200 * HardFrame::e_per_px / 17);
    EXPECT_EQ(scene.detected().detections.size(), 1u) << angle;
  }
}

// Trains of 300 electrons per px, an SNR of 4, and of 2000.
TEST(HardOpen, ATrainWithGapsOfEightPixelsIsTen) {
  for (const double e_per_px : {300.0, 2000.0}) {
    HardFrame scene(800, 500, 5);
    for (int i = 0; i < 10; ++i)
      scene.add({60 + 68 * i * std::cos(0.4), 60 + 68 * i * std::sin(0.4), 60, 0.4, 60 * e_per_px});
    expect_streaks_alone(scene, {.flux = 0.1});
  }
}

TEST(HardOpen, ABlinkingOneIsFoundFromItsFirstFlashToItsLast) {
  HardFrame scene(600, 600, 7);
  expect_pieces(scene, add_row(scene, {200, 250}, 6, 20, 20), 2, 3);
}

// Through a corner, and through the whole frame.
TEST(HardOpen, ThatLeaveTheFrameEndAtItsEdge) {
  expect_part_inside({470, 30, 240, -0.7, 240 * 500.0});
  expect_part_inside({250, 250, 900, 0.6, 900 * 500.0});
}

// Their middle is on the frame's edge: of 200 px some 100 are inside.
TEST(HardOpen, ThatLeaveTheFrameAnywhereAreFound) {
  int found = 0;
  for (unsigned i = 0; i < 40; ++i) {
    HardFrame scene(500, 500, 20 + i);
    const double angle = scene.frame.uniform(0, pi), t = scene.frame.uniform(50, 450);
    const PixelPosition middle = i % 4 == 0   ? PixelPosition{0, t}
                                 : i % 4 == 1 ? PixelPosition{499, t}
                                 : i % 4 == 2 ? PixelPosition{t, 0}
                                              : PixelPosition{t, 499};
    scene.add(middle.x_px, middle.y_px, 200, angle);
    found += scene.detected().detections.size() == 1;
  }
  EXPECT_GE(found, 39);
}

TEST(HardOpen, ABentOneIsOneWithItsEnds) {
  for (const double sagitta_px : {3.0, 6.0}) expect_bent_streak(sagitta_px);
}

// The slope of the glow is no slope of the streak.
TEST(HardOpen, TheMoonsGlowDoesNotMoveAStreaksCentroid) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    HardFrame scene(1000, 900, seed);
    scene.add(800, 230, 150, 2.1);
    add_moon(scene);
    const auto result = scene.detected();
    ASSERT_EQ(result.detections.size(), 1u);
    const Detection& d = result.detections[0];
    const double dx = d.x_px - 800, dy = d.y_px - 230;
    const auto [xx, xy, yy] = d.covariance_px2;
    EXPECT_LT((dx * dx * yy - 2 * dx * dy * xy + dy * dy * xx) / (xx * yy - xy * xy), 12.0)
        << text_of(d);
  }
}

TEST(HardOpen, ACheckerboardOfWideSquaresGivesNothing) {
  HardFrame scene(500, 400, 11);
  scene.change([](double e, int x, int y) { return e + 200 * ((x / 40 + y / 40) % 2); });
  expect_streaks_alone(scene);
}

}  // namespace
}  // namespace dmise::simulated
