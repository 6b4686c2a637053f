#include "core/score/scored_run.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/products/product_json.h"
#include "core/score/score.h"

namespace dmise {
namespace {

struct ScoredRun : testing::Test {
  ScoredRun() {
    std::string path = testing::TempDir() + "dmise-score-XXXXXX";
    directory = mkdtemp(path.data());
    write("run.json", run_json("complete"));
    report.sensor = truth.sensor = detection.sensor = "eye";
    report.frame = truth.frame = detection.frame = 3;
    report.end = truth.end = SimTime{2000000000};
    report.wcs.cd_deg = {-0.01, 0.0, 0.0, 0.01};
    report.noise_e = 12.5;
    truth.name = "GOES, \"13\"";
    truth.catalogue_number = 29155;
    truth.sunlit = 1.0;
    truth.true_magnitude = 9.5;
    truth.rendered_signal_e = 1234.0;
    truth.rendered_x_px = 20.5;
    truth.rendered_y_px = 30.0;
    truth.start_x_px = 10.0;
    truth.middle_x_px = 20.5;
    truth.end_x_px = 31.0;
    truth.start_y_px = truth.middle_y_px = truth.end_y_px = 30.0;
    truth.true_ra_rad = 1.5;
    truth.true_dec_rad = -0.25;
    truth.in_frame = truth.whole = true;
    detection.id = "eye/3/0";
    detection.kind = DetectionKind::streak;
    detection.epoch = ExposureEpoch::middle;
    detection.time = SimTime{1000000000};
    detection.end2_time = SimTime{2000000000};
    detection.covariance_px2 = {0.01, 0.002, 0.03};
    detection.covariance_rad2 = {1e-12, 2e-13, 3e-12};
    detection.sensor_position_m = {1.0, 2.0, 3.0};
    detection.x_px = 20.25;
    detection.y_px = 30.5;
    detection.end1_x_px = 10.5;
    detection.end2_x_px = 30.0;
    detection.end1_y_px = detection.end2_y_px = 30.0;
    detection.corrected_ra_rad = 1.25;
    detection.length_px = 19.5;
    detection.snr = 44.0;
    detection.at_edge = true;
    put();
  }
  ~ScoredRun() override { std::filesystem::remove_all(directory); }

  static std::string run_json(const std::string& status) {
    return R"({"status":")" + status +
           R"(","scenario":{"sensors":[{"name":"eye","camera":{"columns":640,)" +
           R"("rows":480,"psf_fwhm_px":1.5,"aperture_m":0.05,"focal_length_m":0.1,"pixel_pitch_m":5e-6,)" +
           R"("band_centre_m":5.5e-7}}]}})";
  }
  static std::string utc(SimTime) { return "2018-01-21T00:15:00Z"; }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(directory + "/" + name) << text;
  }
  /// The three files with a line of each record.
  void put() const {
    write("frames.jsonl", to_json(report, utc) + "\n");
    write("truth.jsonl", to_json(truth, utc) + "\n");
    write("detections.jsonl", to_json(detection, utc) + "\n");
  }
  ScoreInput read() const { return read_run(directory, quietly); }
  std::string refusal() const {
    try {
      read();
    } catch (const ConfigError& e) {
      return e.what();
    }
    return "none";
  }

  std::string directory;
  FrameReport report;
  Truth truth;
  Detection detection;
};

TEST_F(ScoredRun, ReadWhatTheSensorsWrote) {
  const ScoreInput in = read();
  ASSERT_EQ(in.frames.size() + in.truths.size() + in.detections.size(), 3u);
  const ScoredFrame& f = in.frames[0];
  EXPECT_EQ(f.sensor + "/" + f.frame, "eye/3");
  EXPECT_EQ(f.columns, 640);
  EXPECT_EQ(f.rows, 480);
  EXPECT_EQ(f.noise_e, 12.5);
  EXPECT_DOUBLE_EQ(f.exposure_s, 2.0);
  EXPECT_NEAR(f.scale_rad_per_px, 0.01 * deg, 1e-15);
  // Airy's FWHM of 1.029 lambda / D is 0.226 px of 5e-5 rad, in quadrature with 1.5 px.
  EXPECT_NEAR(*f.sigma_px, std::hypot(1.5, 1.029 * 5.5e-7 / 0.05 / 5e-5) / 2.354820, 1e-4);
  const TrueSource& t = in.truths[0];
  EXPECT_EQ(t.id, "29155 GOES, \"13\"");
  EXPECT_EQ(t.light, (PixelPosition{20.5, 30.0}));
  EXPECT_EQ(t.signal_e, 1234.0);
  EXPECT_EQ(t.magnitude, 9.5);
  EXPECT_NEAR(*t.ra_rad, 1.5, 1e-14);
  EXPECT_TRUE(t.whole);
  Detection back = in.detections[0].detection;
  EXPECT_NEAR(back.corrected_ra_rad, 1.25, 1e-14);
  EXPECT_NEAR(back.covariance_rad2[1], 2e-13, 1e-25);
  back.corrected_ra_rad = 1.25;
  back.covariance_rad2 = detection.covariance_rad2;
  EXPECT_EQ(back, detection);
}

TEST_F(ScoredRun, TruthIsAsBrightAsItIsLit) {
  truth.sunlit = 0.25;
  put();
  const ScoreInput in = read();
  EXPECT_NEAR(*in.truths[0].magnitude, 9.5 + 2.5 * std::log10(4.0), 1e-12);
  EXPECT_FALSE(in.truths[0].whole);
}

TEST_F(ScoredRun, TruthWithoutLightHasNone) {
  truth.rendered_signal_e = 0.0;
  put();
  EXPECT_FALSE(read().truths[0].light);
}

// An instant that the camera does not image is written as (0, 0).
TEST_F(ScoredRun, EndThatIsNotImagedIsWhereTheTrailGoesOn) {
  truth.whole = false;
  truth.end_x_px = truth.end_y_px = 0.0;
  put();
  EXPECT_EQ(read().truths[0].end, (PixelPosition{31.0, 30.0}));
}

TEST_F(ScoredRun, FrameWithoutDetectionIsNotSearched) {
  report.detection_off = true;
  put();
  const ScoreInput in = read();
  EXPECT_FALSE(in.frames[0].searched);
  EXPECT_FALSE(in.frames[0].noise_e);
  EXPECT_EQ(score(in, {}).truths[0].fate, Fate::unscored);
}

TEST_F(ScoredRun, LineThatWasInterruptedIsLeftOut) {
  write("truth.jsonl", to_json(truth, utc) + "\n" + to_json(truth, utc).substr(0, 100));
  EXPECT_EQ(read().truths.size(), 1u);
}

TEST_F(ScoredRun, EmptyRunIsScored) {
  for (const char* name : {"frames.jsonl", "truth.jsonl", "detections.jsonl"}) write(name, "");
  const Score s = score(read(), {});
  EXPECT_EQ(s.sensors.size(), 1u);
  EXPECT_EQ(s.sensors[0].truths, 0u);
}

TEST_F(ScoredRun, MissingFilesAreNamed) {
  for (const char* name : {"detections.jsonl", "truth.jsonl", "frames.jsonl", "run.json"}) {
    std::filesystem::remove(directory + "/" + name);
    EXPECT_EQ(refusal().rfind(directory + "/" + name + ": ", 0), 0u) << refusal();
  }
}

TEST_F(ScoredRun, RefusalsNameFileLineAndKey) {
  const auto refused = [&](const std::string& file, std::string line, const std::string& from,
                           const std::string& to) {
    put();
    const auto at = line.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    line.replace(at, from.size(), to);
    write(file, line + "\n");
    std::string text = refusal();
    EXPECT_EQ(text.rfind(directory + "/" + file + ":1: ", 0), 0u) << text;
    EXPECT_EQ(text.find('\n'), std::string::npos);
    return text.substr(std::min(text.size(), directory.size() + file.size() + 5));
  };
  const std::string frame_line = to_json(report, utc), truth_line = to_json(truth, utc),
                    detection_line = to_json(detection, utc);
  EXPECT_EQ(refused("detections.jsonl", detection_line, "\"x_px\":20.25", "\"x_px\":null"),
            "x_px: must be a number, got null");
  EXPECT_EQ(refused("detections.jsonl", detection_line, "\"x_px\":20.25", "\"x_px\":NaN"),
            "must be a JSON object");
  EXPECT_EQ(refused("detections.jsonl", detection_line, "\"x_px\":20.25", "\"x_px\":1e999"),
            "must be a JSON object");
  EXPECT_EQ(refused("detections.jsonl", detection_line, "\"x_px\":20.25", "\"x_px\":1e300"),
            "x_px: must be at most 1e30, got 1e+300");
  EXPECT_EQ(
      refused("detections.jsonl", detection_line, "\"x_px\":20.25", "\"range_m\":7e5,\"x_px\":1"),
      "range_m: goes with range_sigma_m");
  EXPECT_EQ(refused("detections.jsonl", detection_line, "\"x_px\":20.25",
                    "\"range_rate_sigma_m_per_s\":1,\"x_px\":1"),
            "range_rate_m_per_s: goes with range_rate_sigma_m_per_s");
  EXPECT_EQ(refused("detections.jsonl", detection_line, "[0.01,0.002,0.03]", "[0.01,-2e30,0.03]"),
            "covariance_px2: must be at most 1e30, got [0.01,-2e+30,0.03]");
  EXPECT_EQ(refused("detections.jsonl", detection_line, "\"x_px\":20.25,", ""), "x_px: is missing");
  EXPECT_EQ(refused("detections.jsonl", detection_line, "\"at_edge\":true", "\"at_edge\":1"),
            "at_edge: must be true or false, got 1");
  EXPECT_EQ(refused("detections.jsonl", detection_line, "\"frame\":3", "\"frame\":-3"),
            "frame: must be a whole number in range, got -3");
  EXPECT_EQ(
      refused("detections.jsonl", detection_line, "\"kind\":\"streak\"", "\"kind\":\"comet\""),
      "kind: must be one of point, streak, got comet");
  EXPECT_EQ(refused("detections.jsonl", detection_line, "[0.01,0.002,0.03]", "[0.01,0.002]"),
            "covariance_px2: must be 3 numbers, got [0.01,0.002]");
  EXPECT_EQ(refused("truth.jsonl", truth_line, "\"sunlit\":1", "\"sunlit\":\"yes\""),
            "sunlit: must be a number, got \"yes\"");
  EXPECT_EQ(refused("frames.jsonl", frame_line, "\"sensor\":\"eye\"", "\"sensor\":\"ear\""),
            "sensor: is not in run.json: ear");
  EXPECT_EQ(refused("frames.jsonl", frame_line, frame_line, "[1, 2]"), "must be a JSON object");
  EXPECT_EQ(refused("frames.jsonl", frame_line, frame_line, ""), "must be a JSON object");
}

TEST_F(ScoredRun, SecondLineOfOneThingIsRefused) {
  for (const auto& [name, line, key] : {std::tuple{"frames.jsonl", to_json(report, utc), "frame"},
                                        {"truth.jsonl", to_json(truth, utc), "name"},
                                        {"detections.jsonl", to_json(detection, utc), "id"}}) {
    put();
    write(name, line + "\n" + line + "\n");
    EXPECT_EQ(refusal().rfind(directory + "/" + name + ":2: " + key + ": is there twice: ", 0), 0u)
        << refusal();
  }
}

TEST_F(ScoredRun, InterruptedRunSaysSo) {
  write("run.json", run_json("interrupted"));
  EXPECT_EQ(read().status, "interrupted");
  write("run.json", "{\"status\":\"complete\"");
  EXPECT_NE(refusal().find("run.json: must be a JSON object"), std::string::npos);
}

}  // namespace
}  // namespace dmise
