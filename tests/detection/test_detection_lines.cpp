#include "core/products/product_json.h"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <cmath>

#include "core/base/error.h"
#include "core/base/files/whole_file.h"
#include "core/base/units.h"
#include "core/detection/detection_lines.h"
#include "core/image/fits_cards.h"
#include "core/image/fits_file.h"
#include "core/products/frame_report.h"
#include "tests/support/detect_frame.h"
#include "tests/support/simulated_frame.h"

namespace dmise {
namespace {

std::string utc(SimTime time) { return "T" + std::to_string(time.ns); }

// JSON is a subset of YAML: an independent parser reads it.
TEST(DetectionJson, AnglesAreDegreesAndTimesBothForms) {
  Detection d;
  d.id = "a\"b/1/0";
  d.kind = DetectionKind::streak;
  d.time = {5};
  d.ra_rad = pi / 2;
  d.covariance_rad2 = {4 * arcsec * arcsec, 0, 0};
  const std::string line = to_json(d, utc);
  EXPECT_EQ(line.find('\n'), std::string::npos);
  const YAML::Node node = YAML::Load(line);
  EXPECT_EQ(node["id"].as<std::string>(), "a\"b/1/0");
  EXPECT_EQ(node["kind"].as<std::string>(), "streak");
  EXPECT_EQ(node["time_ns"].as<std::int64_t>(), 5);
  EXPECT_EQ(node["time_utc"].as<std::string>(), "T5");
  EXPECT_DOUBLE_EQ(node["ra_deg"].as<double>(), 90.0);
  EXPECT_NEAR(node["covariance_arcsec2"][0].as<double>(), 4.0, 1e-12);
  EXPECT_FALSE(node["direction_known"].as<bool>());
}

TEST(DetectionJson, ReportAndTruthAreOneObjectEach) {
  FrameReport report;
  report.wcs.order = 2;
  report.wcs.a.assign(9, 0.5);
  const YAML::Node node = YAML::Load(to_json(report, utc));
  EXPECT_EQ(node["wcs"]["a"].size(), 9u);
  EXPECT_EQ(node["detections"].as<int>(), 0);
  EXPECT_FALSE(node["detection_off"]);
  report.detection_off = true;
  const YAML::Node off = YAML::Load(to_json(report, utc));
  EXPECT_TRUE(off["detection_off"].as<bool>());
  EXPECT_TRUE(off["limiting_magnitude"].IsNull());
  EXPECT_EQ(off["detections"].as<int>(), 0);
  Truth truth;
  truth.name = "COSMOS 2519";
  truth.true_dec_rad = -pi / 6;
  const YAML::Node true_node = YAML::Load(to_json(truth, utc));
  EXPECT_EQ(true_node["name"].as<std::string>(), "COSMOS 2519");
  EXPECT_NEAR(true_node["true_dec_deg"].as<double>(), -30.0, 1e-12);
  EXPECT_TRUE(true_node["rendered_px"].IsNull());  // no light falls on no pixel
  truth.rendered_signal_e = 5.0;
  truth.rendered_y_px = 7.0;
  EXPECT_EQ(YAML::Load(to_json(truth, utc))["rendered_px"][1].as<double>(), 7.0);
}

TEST(DetectionJson, NoNanLeaves) {
  Detection d;
  d.magnitude = std::nan("");
  try {
    to_json(d, utc);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("magnitude"), std::string::npos);
  }
}

TEST(DetectionLines, FileGivesTheSameBytesAsTheFrameInMemory) {
  const auto header = simulated::camera_header(500, 400, 1663, 34 * deg, 20, true);
  simulated::SimulatedFrame simulated(header, 500, 400, 1500, 3);
  simulated.add_stars(300, 500, 1e6);
  simulated.add_streak(250, 200, 120, 0.4, 120 * 400.0);
  simulated.add_point(100, 300, 20000);
  const CountImage counts = simulated.expose();
  const std::string path = testing::TempDir() + "/detect.fits";
  for (const auto compression : {FitsCompression::none, FitsCompression::rice}) {
    write_frame(path, counts, header, compression);
    Threads one(1), two(2);
    const auto from_file = test::detect_frame(read_frame(path), two);
    const FrameHeader kept = as_in_file(header);
    const auto in_memory = detect(counts, kept, {}, one);
    const UtcText text = [&](SimTime time) { return utc_in_frame(kept, time); };
    ASSERT_EQ(from_file.lines.size(), in_memory.detections.size());
    ASSERT_GE(from_file.lines.size(), 2u);
    for (std::size_t i = 0; i < from_file.lines.size(); ++i)
      EXPECT_EQ(from_file.lines[i], to_json(in_memory.detections[i], text));
    EXPECT_EQ(from_file.report, to_json(in_memory.report, text));
  }
}

TEST(ReadFrame, NoFrameIsOneClearLine) {
  const std::string path = testing::TempDir() + "/not-a-frame.fits";
  write_file_whole(path, "hello");
  try {
    read_frame(path);
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_EQ(std::string(error.what()), path + ": SIMPLE: not a FITS file");
  }
  EXPECT_THROW(read_frame("/nonexistent.fits"), ConfigError);
}

}  // namespace
}  // namespace dmise
