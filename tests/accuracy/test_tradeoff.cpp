#include "sensors/accuracy/tradeoff.h"

#include <algorithm>
#include <cmath>

#include "tests/pipeline/harness.h"

namespace dmise {
namespace {

TEST(TradeoffRow, IsReadBackWithWhatWasNotMeasured) {
  TradeoffRow row{.effect = "sky", .level = "off", .bound = {0.0, 0.5, unbounded, 0.25}};
  row.measured.photometry_mag = row.detected = std::nan("");
  row.seconds = 2.0;
  const std::string line = csv_line(row);
  EXPECT_EQ(line, "sky,off,0,0.5,inf,0.25,,0,0,0,0,,2,0");
  const auto back = row_of_csv(line);
  ASSERT_TRUE(back);
  EXPECT_TRUE(std::isnan(back->measured.photometry_mag));
  EXPECT_TRUE(std::isnan(back->detected));
  EXPECT_EQ(back->bound, row.bound);
  EXPECT_EQ(csv_line(*back), line);
}

// An empty sky: there is no source whose light or place could be wrong.
TEST(Tradeoff, MeasuresNoErrorOfSourcesThatAreNotThere) {
  test::Stage stage(
      "accuracy: standard\n"
      "simulation: {start: 2018-01-21T00:15:00Z, duration_s: 10, tick_s: 5, seed: 1}\n"
      "sensors: [{name: watch, site: savannah, camera: geo-watch, pointing: zenith, "
      "exposure_s: 1, cadence_s: 10}]\n");
  stage.scenario.sensors[0].camera.optics.columns = 64;
  stage.scenario.sensors[0].camera.optics.rows = 48;
  const SceneFrames scene(stage.scenario, "watch", 1, stage.threads);
  const Tradeoff trade(scene, 1);
  ASSERT_EQ(trade.notes().size(), 1u);
  EXPECT_NE(trade.notes()[0].find("no isolated source"), std::string::npos);
  const auto sky = std::ranges::find_if(trade.rows(), [](const TradeoffRow& row) {
    return row.effect == "sky" && row.level == "off";
  });
  ASSERT_NE(sky, trade.rows().end());
  const TradeoffRow row = trade.measure(std::size_t(sky - trade.rows().begin()));
  EXPECT_TRUE(std::isnan(row.measured.photometry_mag));
  EXPECT_TRUE(std::isnan(row.measured.position_px));
  EXPECT_TRUE(std::isnan(row.detected));
  EXPECT_GT(row.measured.background_sigma, 0.0);
  EXPECT_GE(row.bound.background_sigma, row.measured.background_sigma)
      << "a level that is forced states its bound all the same";
}

}  // namespace
}  // namespace dmise
