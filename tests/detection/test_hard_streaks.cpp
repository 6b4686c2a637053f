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

/// A mount that follows the stars and a point spread of 4 px: streaks of an SNR of 20, and bright
/// stars that light parts of lines beside them.
std::size_t found_among_bright_stars(int stars) {
  constexpr int size = 600;
  FrameHeader header = camera_header(size, size, 5000, 0, 5, false);
  header.psf_fwhm_px = 4;
  header.mount = "unknown";
  SimulatedFrame frame(header, size, size, HardFrame::sky_e, 31);
  std::vector<TrueStreak> streaks;
  for (int i = 0; i < 4; ++i)
    streaks.push_back({150.0 + 100 * i, 120.0 + 120 * i, 50.0 + 10 * i, 0.4 + 0.7 * i, 30000});
  for (const TrueStreak& s : streaks)
    frame.add_streak(s.x_px, s.y_px, s.length_px, s.angle_rad, s.flux_e);
  for (int i = 0; i < stars;) {
    const PixelPosition at{frame.uniform(0, size), frame.uniform(0, size)};
    if (std::ranges::any_of(streaks, [&](const auto& s) { return s.distance_px(at) < 20; }))
      continue;
    frame.add_point(at.x_px, at.y_px, 2e4 * std::pow(30, frame.uniform(0, 1)));
    ++i;
  }
  Threads one;
  const DetectionResult result = detect(frame.expose(), header, nullptr, one);
  std::size_t found = 0;
  for (const Detection& d : result.detections) {
    const bool is_true = std::ranges::any_of(streaks, [&](const auto& s) {
      return s.distance_px({d.x_px, d.y_px}) < 3;
    });
    EXPECT_TRUE(is_true) << text_of(d);
    found += is_true;
  }
  return found;
}

TEST(HardStreaks, AmongBrightStarsAreFound) {
  for (const int stars : {20, 60, 120}) EXPECT_EQ(found_among_bright_stars(stars), 4u) << stars;
}

// A line that is lit where a bright star lies has more light than the streak.
TEST(HardStreaks, AFaintOneBeforeABrightStarStaysWhereItIs) {
  for (const unsigned seed : {21U, 22U, 23U}) {
    HardFrame scene(500, 400, seed);
    scene.add({200, 200, 40, 0.3, 9000});
    const PixelPosition beyond = scene.streaks[0].at(55);
    scene.frame.add_star(beyond.x_px, beyond.y_px, 2e6);
    for (const Detection& d : scene.detected().detections)
      EXPECT_LT(scene.streaks[0].distance_px({d.x_px, d.y_px}), 4) << seed << " " << text_of(d);
  }
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
        for (const double turn : {pi / 2, pi / 3}) {  // angle of the border to the streak
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
          // SNR of the matched filter, with a PSF of 0.8 px in noise of 40 e-.
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
/// A streak of even light across, `width_px` wide and of 10 sigma of the noise in each pixel.
void add_broad(HardFrame& scene, const TrueStreak& s, double width_px) {
  const double e_per_px2 = 10 * std::hypot(std::sqrt(HardFrame::sky_e), 9.3);
  scene.change([&](double e, int x, int y) {
    const PixelPosition at{double(x), double(y)};
    const bool lit =
        std::abs(s.across(at)) < width_px / 2 && std::abs(s.along(at)) < s.length_px / 2;
    return e + (lit ? e_per_px2 : 0.0);
  });
}

// Out of focus, as large telescopes see low orbits.
TEST(HardStreaks, ABroadOneIsOne) {
  for (const double width_px : {5.0, 7.0, 10.0, 14.0})
    for (const double length_px : {240.0, 2000.0})
      for (const double angle : {0.0, 0.4, 1.3, 2.4}) {
        SCOPED_TRACE(testing::Message() << width_px << " x " << length_px << " px at " << angle);
        HardFrame scene(512, 512, 32);
        scene.frame.add_stars(120, 100, 20000);
        const TrueStreak broad{256, 256, length_px, angle, 0.0};
        add_broad(scene, broad, width_px);
        const auto found = scene.detected().detections;
        EXPECT_EQ(found.size(), 1u);
        if (found.empty()) continue;
        EXPECT_EQ(found[0].kind, DetectionKind::streak);
        EXPECT_LT(std::abs(broad.across({found[0].x_px, found[0].y_px})), 1.5);
        if (length_px < 500) {
          EXPECT_NEAR(found[0].length_px, length_px, 10);
          EXPECT_NEAR(broad.along({found[0].x_px, found[0].y_px}), 0.0, 5.0);
        } else {
          EXPECT_GT(found[0].length_px, 490);
        }
      }
}

// Streaks of an SNR of up to 2,000, brighter or fainter by 40 % each 4 px.
TEST(HardStreaks, ABrightOneThatFlickersIsFound) {
  for (const double e_per_px : {1000.0, 5000.0, 25000.0}) {
    HardFrame scene(600, 600, 33);
    const TrueStreak whole{300, 300, 120, 0.4, 120 * e_per_px};
    std::normal_distribution<double> normal(1.0, 0.4);
    for (double along = -58; along < 60; along += 4) {
      const PixelPosition at = whole.at(along);
      const double light = std::clamp(normal(scene.frame.random()), 0.3, 1.7);
      scene.frame.add_streak(at.x_px, at.y_px, 4, 0.4, 4 * e_per_px * light);
    }
    const auto found = scene.detected().detections;
    ASSERT_EQ(found.size(), 1u) << e_per_px;
    EXPECT_LT(std::abs(whole.across({found[0].x_px, found[0].y_px})), 0.3);
    EXPECT_NEAR(found[0].length_px, 120, 6);
  }
}

// An exponential disc that is 3 times as wide as the PSF, from too faint to be seen to an SNR
// of 60.
TEST(HardStreaks, AGalaxyFromItsSideIsNoStreak) {
  int seen = 0;
  for (const double e_per_px2 : {12.0, 20.0, 30.0, 50.0, 100.0})
    for (int i = 0; i < 4; ++i) {
      HardFrame scene(400, 400, unsigned(60 + i));
      const TrueStreak galaxy{200, 200, 40, 0.3 + 0.7 * i, 0.0};
      scene.change([&](double e, int x, int y) {
        const PixelPosition at{double(x), double(y)};
        const double across = galaxy.across(at) / 2.3;
        return e + e_per_px2 * std::exp(-std::abs(galaxy.along(at)) / 7 - 0.5 * across * across);
      });
      for (const Detection& d : scene.detected().detections)
        if (d.kind == DetectionKind::streak) ++seen;
    }
  EXPECT_EQ(seen, 0);
}

// The greatest of each pixel's counts in 8 frames, in each of which an eighth of the way is lit.
TEST(HardStreaks, OneInAPlaneOfMaximaIsFound) {
  const TrueStreak whole{300, 300, 160, 0.4, 160 * 5000.0};
  CountImage most(600, 600);
  FrameHeader header;
  for (int i = 0; i < 8; ++i) {
    HardFrame scene(600, 600, unsigned(40 + i));
    const PixelPosition at = whole.at(-70 + 20 * i);
    scene.frame.add_streak(at.x_px, at.y_px, 20, 0.4, whole.flux_e / 8);
    const CountImage counts = scene.frame.expose();
    header = scene.frame.header();
    for (std::size_t k = 0; k < most.pixels.size(); ++k)
      most.pixels[k] = std::max(most.pixels[k], counts.pixels[k]);
  }
  Threads threads(2);
  const auto found = detect(most, header, {}, threads).detections;
  ASSERT_EQ(found.size(), 1u);
  EXPECT_LT(std::abs(whole.across({found[0].x_px, found[0].y_px})), 0.3);
  EXPECT_NEAR(found[0].length_px, 160, 4);
}

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
