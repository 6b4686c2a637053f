#include "core/ingest/colour_mosaic.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/ingest/foreign_scene.h"

namespace dmise {
namespace {

using namespace test;

constexpr double dyes[] = {0.55, 1.0, 1.0, 0.45};  // at pixels (0, 0), (1, 0), (0, 1), (1, 1)
constexpr double mean_dye = 0.75;

/// The frame behind a mosaic of dyes, of each electron by chance: 0.5 electrons a count, bias 100.
ForeignImage behind_dyes(const CountImage& counts, std::vector<std::string> cards) {
  cards.push_back(card("BAYERPAT", "'RGGB'"));
  ForeignImage image = image_of(counts, std::move(cards));
  std::mt19937_64 random(9);
  for (int y = 0; y < counts.rows; ++y)
    for (int x = 0; x < counts.columns; ++x) {
      double& v = image.values[std::size_t(y) * std::size_t(counts.columns) + std::size_t(x)];
      const double e = std::max(0.5 * (v - 100), 0.0), dye = dyes[x % 2 + 2 * (y % 2)];
      std::normal_distribution<double> normal(e * dye, std::sqrt(e * dye * (1 - dye)) + 1e-9);
      v = std::round(100 + std::max(normal(random), 0.0) / 0.5);
    }
  return image;
}

TEST(ColourMosaic, EvensSkyAndResponses) {
  const Scene scene = draw(false, 4);
  const ForeignImage image = behind_dyes(scene.counts, {});
  Threads one(1);
  const ColourMosaic mosaic(image.values, columns, one);
  ASSERT_TRUE(mosaic.responses());
  for (std::size_t kind = 0; kind < 4; ++kind)
    EXPECT_NEAR((*mosaic.responses())[kind], dyes[kind] / mean_dye, 0.05 * dyes[kind]);
}

TEST(ColourMosaic, StreaksAreFoundWhateverTheirLight) {
  FrameHeader h = simulated::camera_header(columns, rows, focal_px, 0.4, 4, false);
  simulated::SimulatedFrame drawn(h, columns, rows, 200, 4);
  drawn.add_stars(150, 1500, 60000);
  drawn.add_streak(150, 300, 60, 0.5, 30000);
  drawn.add_streak(330, 120, 35, 2.2, 16000);
  drawn.add_streak(380, 280, 80, 1.1, 400000);
  const Scene scene{h, drawn.expose()};
  const auto expected = detections_in({scene.counts, scene.header});
  const Frame frame = read_one(behind_dyes(scene.counts, all_cards(scene.header)));
  const auto got = detections_in(frame);
  ASSERT_EQ(expected.size(), 3u);
  ASSERT_EQ(got.size(), expected.size());
  for (std::size_t i = 0; i < got.size(); ++i) {
    EXPECT_NEAR(got[i].x_px, expected[i].x_px, 0.5);
    EXPECT_NEAR(got[i].y_px, expected[i].y_px, 0.5);
    EXPECT_NEAR(got[i].signal_e / expected[i].signal_e, mean_dye, 0.1);
  }
}

// The gain of one kind of pixels is that of the camera; differences of the kinds are no noise.
TEST(ColourMosaic, TheGainIsThatOfTheCamera) {
  CountImage counts(1024, 1024);
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  for (int y = 0; y < 1024; ++y)
    for (int x = 0; x < 1024; ++x) {
      const double e = 400 + 4 * x;
      counts.at(x, y) = std::uint16_t(std::lround(100 + (e + std::sqrt(e) * normal(random)) / 0.5));
    }
  const Frame frame = read_one(behind_dyes(counts, {}));
  EXPECT_FALSE(frame.header.unknown.has(FrameFact::gain));
  EXPECT_THAT(frame.notes.assumed,
              testing::Contains(testing::ContainsRegex("gain: 0\\.(4[5-9]|5)")));
}

}  // namespace
}  // namespace dmise
