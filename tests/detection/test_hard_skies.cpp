#include "tests/detection/hard_expectations.h"

// Streaks in a sky, or a pattern of the detector, that is anything but even.
namespace dmise::simulated {
namespace {

/// A smooth step from 0 to 1 around 0, over about `width`.
double step(double distance, double width) { return 0.5 * (1 + std::erf(distance / width)); }

void expect_streaks_before_a_cloud(double width_px, double tilt, unsigned seed) {
  HardFrame scene(800, 700, seed);
  scene.add(180, 150, 120, 0.4);
  scene.add(640, 230, 150, 2.1);
  scene.add(200, 560, 90, -0.9);
  scene.change([&](double e, int x, int y) {
    return e + 3000 * step(x - 430 - tilt * (y - 350), width_px);
  });
  expect_streaks_alone(scene);
}

TEST(HardSkies, HalfTheFrameCloudWithASharpEdge) {
  expect_streaks_before_a_cloud(0.3, 0.0, 1);
  expect_streaks_before_a_cloud(0.3, 0.2, 2);
}

TEST(HardSkies, HalfTheFrameCloudWithASoftEdge) {
  expect_streaks_before_a_cloud(8, 0.2, 3);
  expect_streaks_before_a_cloud(40, 0.2, 4);
}

// The streak's brightness is the same on both sides.
TEST(HardSkies, AStreakAcrossACloudsEdgeIsFoundWhole) {
  HardFrame scene(800, 700, 5);
  scene.add(430, 350, 300, 0.4);
  scene.change([](double e, int x, int) { return e + 3000 * step(x - 430.0, 40); });
  expect_streaks_alone(scene, {.end_px = 3, .flux = 0.08});
}

TEST(HardSkies, TheMoonInTheField) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    HardFrame scene(1000, 900, seed);
    scene.add(160, 150, 120, 0.4);
    scene.add(800, 230, 150, 2.1);
    scene.add(330, 760, 90, -0.9);
    add_moon(scene);
    expect_streaks_alone(scene);
  }
}

// From 500 to 8500 electrons across the frame, and a twilight that bends.
TEST(HardSkies, ASteepGradient) {
  HardFrame scene(800, 700, 7);
  add_three_streaks(scene);
  scene.change([](double e, int x, int) { return e - 1000 + 10 * x; });
  expect_streaks_alone(scene);
  HardFrame twilight(800, 700, 8);
  add_three_streaks(twilight);
  twilight.change([](double e, int, int y) { return e + 10000 * std::exp(-y / 120.0); });
  expect_streaks_alone(twilight);
}

// One pixel of 700 is up to 60 times the noise too bright, or dead.
TEST(HardSkies, Salt) {
  HardFrame scene(800, 700, 9);
  add_three_streaks(scene);
  for (int i = 0; i < 800; ++i) {
    const double x = scene.frame.uniform(0, 800), y = scene.frame.uniform(0, 700);
    if (!scene.is_clear({x, y}, 6)) continue;
    scene.frame.expected().at(int(x), int(y)) += float(std::pow(10, scene.frame.uniform(2, 4.4)));
  }
  expect_streaks_alone(scene);
}

TEST(HardSkies, SaltAndPepperBeyondAllCounts) {
  HardFrame scene(800, 700, 10);
  add_three_streaks(scene);
  for (int i = 0; i < 800; ++i) {
    const double x = scene.frame.uniform(0, 800), y = scene.frame.uniform(0, 700);
    if (!scene.is_clear({x, y}, 6)) continue;
    scene.frame.expected().at(int(x), int(y)) = i % 2 ? 1e6f : 0.0f;
  }
  expect_streaks_alone(scene);
}

/// A pattern of `amplitude_e` by place, over a sky in which nothing is.
template <class Pattern>
std::size_t found_in(double amplitude_e, const Pattern& pattern) {
  HardFrame scene(500, 400, 11);
  scene.change([&](double e, int x, int y) { return e + amplitude_e * pattern(x, y); });
  return scene.detected().detections.size();
}

TEST(HardSkies, CheckerboardsGiveNothing) {
  for (const double amplitude_e : {20.0, 200.0, 4000.0})
    for (const int side : {1, 2, 7, 16})
      EXPECT_EQ(found_in(amplitude_e, [&](int x, int y) { return (x / side + y / side) % 2; }), 0u)
          << amplitude_e << " e-, squares of " << side << " px";
}

// Columns, rows and diagonals, two or three in a row alike.
TEST(HardSkies, StripesGiveNothing) {
  for (const double amplitude_e : {10.0, 200.0, 4000.0}) {
    EXPECT_EQ(found_in(amplitude_e, [](int x, int) { return x / 2 % 2; }), 0u) << amplitude_e;
    EXPECT_EQ(found_in(amplitude_e, [](int, int y) { return y / 2 % 2; }), 0u) << amplitude_e;
    EXPECT_EQ(found_in(amplitude_e, [](int x, int y) { return (x + y) / 3 % 2; }), 0u)
        << amplitude_e;
  }
}

// A detector's columns with offsets of a third of a pixel's noise.
TEST(HardSkies, StreaksAreFoundInColumnNoise) {
  HardFrame scene(800, 700, 12);
  add_three_streaks(scene);
  std::vector<double> offset_e(800);
  for (double& e : offset_e) e = scene.frame.uniform(-20, 20);
  scene.change([&](double e, int x, int) { return e + offset_e[std::size_t(x)]; });
  expect_streaks_alone(scene);
}

TEST(HardSkies, AStreakIsFoundOverAFineCheckerboard) {
  HardFrame scene(800, 700, 13);
  add_three_streaks(scene);
  scene.change([](double e, int x, int y) { return e + ((x + y) % 2 ? 20 : -20); });
  expect_streaks_alone(scene);
}

TEST(HardSkies, HalfTheFrameAtTheLimitOfCounts) {
  for (const bool along_rows : {false, true}) {
    HardFrame scene(800, 700, 14);
    scene.add(180, 150, 120, 0.4);
    scene.change(
        [&](double e, int x, int y) { return (along_rows ? y > 350 : x > 400) ? 1e6 : e; });
    expect_streaks_alone(scene);
  }
}

TEST(HardSkies, CountsAtRandomGiveNothing) {
  Threads threads;
  const FrameHeader header = hard_header(500, 400);
  std::mt19937_64 random(15);
  CountImage counts(500, 400);
  for (auto& pixel : counts.pixels) pixel = std::uint16_t(random() >> 48);
  EXPECT_TRUE(detect(counts, header, {}, threads).detections.empty());
}

}  // namespace
}  // namespace dmise::simulated
