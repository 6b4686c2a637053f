#include "tests/detection/hard_expectations.h"

// Streaks that are near each other, cut, bent or uneven.
namespace dmise::simulated {
namespace {

TEST(HardStreaks, TwoThatCrossHaveTheirEndsAndLight) {
  for (const double angle : {1.5, 0.6, 0.15}) {
    HardFrame scene(600, 600, 1);
    scene.add(300, 300, 300, 0.4);
    scene.add({330, 285, 250, 0.4 + angle, 250 * 400.0});
    expect_streaks_alone(scene, {.flux = 0.08});
  }
}

TEST(HardStreaks, TwoParallelOnesEightPixelsApartAreTwo) {
  for (const double angle : {0.0, 0.4, 1.2}) {
    HardFrame scene(600, 600, 2);
    add_pair(scene, 8, angle);
    expect_streaks_alone(scene);
  }
}

TEST(HardStreaks, AFaintOneSixPixelsBesideABrightOneIsFound) {
  HardFrame scene(600, 600, 3);
  scene.add({300, 300, 250, 0.4, 250 * 5000.0});
  scene.add({300 - 6 * std::sin(0.4), 300 + 6 * std::cos(0.4), 250, 0.4, 250 * 300.0});
  expect_streaks_alone(scene, {.flux = 0.1});
}

TEST(HardStreaks, ATrainOnOneLineIsTen) {
  for (const double gap_px : {30.0, 60.0}) {
    HardFrame scene(1000, 800, 4);
    add_row(scene, {60, 60}, 10, 28, gap_px);
    expect_streaks_alone(scene, {.flux = 0.05});
  }
}

// 8 px apart.
TEST(HardStreaks, ATrainSideBySideIsTen) {
  HardFrame scene(500, 500, 5);
  for (int i = 0; i < 10; ++i)
    scene.add(200 - 8 * i * std::sin(0.4), 200 + 8 * i * std::cos(0.4), 28, 0.4);
  expect_streaks_alone(scene, {.flux = 0.1});
}

TEST(HardStreaks, ThatLeaveTheFrameEndAtItsEdge) {
  expect_part_inside({20, 250, 240, 0.1, 240 * 500.0});
  expect_part_inside({250, 490, 240, 1.2, 240 * 500.0});
}

// From a border at any angle on, pixels have no value: sky stands in for them. Streaks of an SNR of
// 25 to 90 are found up to there, with the light and the SNR of what is seen.
TEST(HardStreaks, ThatRunIntoPixelsWithoutAValueEndAtThem) {
  Threads threads(2);
  for (const double e_per_px : {200.0, 500.0})
    for (const double angle : {0.05, 0.4, 0.8, 1.3, 2.2})
      for (const double seen_px : {70.0, 110.0, 160.0})
        for (const double turn : {pi / 2, pi / 3}) {  // of the border to the streak
          const TrueStreak whole{250, 250, 200, angle, 200 * e_per_px};
          const double border_px = seen_px - whole.length_px / 2;
          const PixelPosition middle = whole.at(border_px - seen_px / 2);
          const TrueStreak seen{middle.x_px, middle.y_px, seen_px, angle, seen_px * e_per_px};
          HardFrame scene(500, 500, 31);
          scene.add(whole);
          PixelMask unusable(500, 500);
          const PixelPosition border = whole.at(border_px);
          scene.change([&](double e, int x, int y) {
            const double beyond = (x - border.x_px) * std::sin(angle + turn) -
                                  (y - border.y_px) * std::cos(angle + turn);
            unusable.at(x, y) = beyond > 0;
            return beyond > 0 ? HardFrame::sky_e : e;
          });
          SCOPED_TRACE(testing::Message() << e_per_px << " e-/px, " << angle << " rad, " << seen_px
                                          << " px, border " << turn);
          const auto found =
              detect(scene.frame.expose(), scene.frame.header(), &unusable, threads).detections;
          ASSERT_EQ(found.size(), 1u);
          expect_is(found[0], seen, {.end_px = e_per_px > 300 ? 3.0 : 8.0});
          EXPECT_TRUE(found[0].at_edge);
          // Of the matched filter, of a PSF of 0.8 px in noise of 40 e-.
          const double ideal = e_per_px * std::sqrt(seen_px / (2 * 0.8 * std::sqrt(pi))) / 40;
          EXPECT_GT(found[0].snr, 0.5 * ideal);
        }
}

// Six flashes of 20 px with 30 px of nothing between them.
TEST(HardStreaks, ABlinkingOneIsFoundFromItsFirstFlashToItsLast) {
  HardFrame scene(600, 600, 7);
  expect_pieces(scene, add_row(scene, {150, 200}, 6, 20, 30), 2, 3);
}

// Brightness 1 + cos over three turns of a tumbling body: it is dark twice.
TEST(HardStreaks, ATumblingOneIsFoundFromEndToEnd) {
  HardFrame scene(700, 600, 8);
  const TrueStreak whole{350, 300, 300, 0.4, 300 * 500.0};
  for (int i = 0; i < 300; ++i) {
    const PixelPosition p = whole.at(i - 149.5);
    scene.frame.add_streak(p.x_px, p.y_px, 1, 0.4, 500 * (1 + std::cos(2 * pi * i / 100)));
  }
  expect_pieces(scene, whole, 2, 5);
}

TEST(HardStreaks, ABentOneIsOneWithItsEnds) { expect_bent_streak(2); }

// A row or a column of pixels with a star, a streak along it and a full pixel.
TEST(HardStreaks, FramesOfOneRowOrColumnGiveFiniteNumbers) {
  for (const auto& [columns, rows] : {std::pair{3000, 1}, {1, 3000}, {3000, 2}, {1, 1}, {2, 2}}) {
    HardFrame scene(columns, rows, 10);
    scene.frame.add_star(columns / 3.0, rows / 3.0, 40000);
    scene.add(columns / 2.0, rows / 2.0, 200, columns > rows ? 0.0 : pi / 2);
    scene.frame.expected().at(columns - 1, rows - 1) = 1e6f;
    EXPECT_LE(scene.detected().detections.size(), 2u);
  }
}

}  // namespace
}  // namespace dmise::simulated
