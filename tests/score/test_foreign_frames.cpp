#include "core/score/foreign_frames.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/image/fits_file.h"
#include "core/score/score.h"
#include "tests/ingest/foreign_file.h"
#include "tests/support/simulated_frame.h"

namespace dmise {
namespace {

struct ForeignFrames : testing::Test {
  ForeignFrames() {
    std::string path = testing::TempDir() + "dmise-frames-XXXXXX";
    directory = mkdtemp(path.data());
    table = directory + "/truth.csv";
  }
  ~ForeignFrames() override { std::filesystem::remove_all(directory); }

  std::vector<TrueSource> read(const std::string& text) const {
    std::ofstream(table) << text;
    return read_truth_csv(table, {"a.fits", "b.fits"});
  }
  std::string refusal(const std::string& text) const {
    try {
      read(text);
    } catch (const ConfigError& e) {
      const std::string what = e.what();
      EXPECT_EQ(what.rfind(table + ":", 0), 0u) << what;
      return what.substr(table.size());
    }
    return "none";
  }

  std::string directory, table;
};

TEST_F(ForeignFrames, TableIsReadInAnyOrderOfColumns) {
  const auto truths = read(
      "\xef\xbb\xbfid,file,y_px,x_px,end1_x_px,end1_y_px,end2_x_px,end2_y_px,signal_e,magnitude,ra_"
      "deg,dec_deg\r\n"
      "\"one, two\",b.fits,20,10.5,5,20,16,20,1e4,8.5,180,-45\r\n"
      "\n"
      "3,a.fits,1,2,,,,,,,,\n");
  ASSERT_EQ(truths.size(), 2u);
  EXPECT_EQ(truths[0].id, "one, two");
  EXPECT_EQ(truths[0].frame, "b.fits");
  EXPECT_EQ(truths[0].light, (PixelPosition{10.5, 20}));
  EXPECT_EQ(truths[0].end, (PixelPosition{16, 20}));
  EXPECT_EQ(truths[0].signal_e, 1e4);
  EXPECT_NEAR(*truths[0].dec_rad, -45 * deg, 1e-12);
  EXPECT_EQ(truths[1].start, (PixelPosition{2, 1}));
  EXPECT_FALSE(truths[1].signal_e || truths[1].magnitude || truths[1].ra_rad);
}

TEST_F(ForeignFrames, BadTablesAreRefusedByLineAndColumn) {
  const std::string head =
      "file,id,x_px,y_px,signal_e,end1_x_px,end1_y_px,end2_x_px,end2_y_px,ra_deg,dec_deg\n";
  const std::string good = "a.fits,1,10,20,,,,,,,\n";
  EXPECT_EQ(refusal(head + good), "none");
  EXPECT_EQ(refusal(""), ": is empty");
  EXPECT_EQ(refusal("file,id,x_px\n"), ":1: y_px: column is missing");
  EXPECT_EQ(refusal("file,id,x_px,y_px,id\n"), ":1: id: column is there twice");
  EXPECT_EQ(refusal("file,id,x_px,y_px,magnitud\n"),
            ":1: unknown column, got \"magnitud\", did you mean magnitude?");
  EXPECT_EQ(refusal(head + good + "a.fits,2,10\n"), ":3: must have 11 fields, got 3");
  EXPECT_EQ(refusal(head + good + good), ":3: id: is there twice for this file, got \"1\"");
  EXPECT_EQ(refusal(head + "c.fits,1,10,20,,,,,,,\n"),
            ":2: file: is not in the directory, got \"c.fits\"");
  EXPECT_EQ(refusal(head + ",1,10,20,,,,,,,\n"), ":2: file: must not be empty, got \"\"");
  for (const char* value : {"", "nan", "inf", "1e9", "12px", "1,5"})
    EXPECT_EQ(refusal(head + "a.fits,1," + value + ",20,,,,,,,\n").rfind(":2: ", 0), 0u) << value;
  EXPECT_EQ(refusal(head + "a.fits,1,NaN,20,,,,,,,\n"),
            ":2: x_px: must be a number in -1e+07..1e+07, got \"NaN\"");
  EXPECT_EQ(
      refusal(head + "a.fits,1,10,20,-5,,,,,,\n").rfind(":2: signal_e: must be a number in ", 0),
      0u);
  EXPECT_EQ(refusal(head + "a.fits,1,10,20,,3,,,,,\n"),
            ":2: end1_y_px: is missing beside end1_x_px, got \"\"");
  EXPECT_EQ(refusal(head + "a.fits,1,10,20,,3,4,,,,\n"),
            ":2: end2_x_px: is missing beside the other end, got \"\"");
  EXPECT_EQ(refusal(head + "a.fits,1,10,20,,,,,,,9\n"),
            ":2: ra_deg: is missing beside dec_deg, got \"\"");
  EXPECT_EQ(refusal(head + "a.fits,1,10,20,,,,,,10,95\n"),
            ":2: dec_deg: must be a number in -90..90, got \"95\"");
}

// A point and a streak drawn by the brute force of tests/detection on an empty sky, and a truth
// outside: found where they were drawn.
TEST_F(ForeignFrames, DetectsInThemAndScores) {
  const FrameHeader header = simulated::camera_header(600, 400, 1663.0, 34 * deg, 20.0, true);
  simulated::SimulatedFrame scene(header, 600, 400, 1500.0, 1);
  scene.add_point(100, 80, 2e4);
  scene.add_streak(230, 175, 80, 2.0, 4e4);
  write_frame(directory + "/a.fits", scene.expose(), header);
  const double dx = 40 * std::cos(2.0), dy = 40 * std::sin(2.0);
  std::ofstream(table) << "file,id,x_px,y_px,end1_x_px,end1_y_px,end2_x_px,end2_y_px,signal_e\n"
                       << "a.fits,point,100,80,,,,,2e4\n"
                       << "a.fits,streak,230,175," << 230 - dx << "," << 175 - dy << "," << 230 + dx
                       << "," << 175 + dy << ",4e4\n"
                       << "a.fits,off,700,80,,,,,5e4\n"
                       << "a.fits,cut,595,300,590,300,610,300,500\n";
  Threads threads(1);
  int calls = 0;
  const Score s = score(read_frames(
                            directory, table, threads, [&](double, const std::string&) { ++calls; },
                            CalibratedDetector(nullptr)),
                        {});
  EXPECT_EQ(calls, 1);
  ASSERT_EQ(s.truths.size(), 4u);  // cut, off, point, streak
  EXPECT_EQ(s.truths[0].fate, Fate::faint);
  EXPECT_FALSE(s.truths[0].truth.whole);
  EXPECT_EQ(s.truths[1].fate, Fate::outside);
  EXPECT_EQ(s.truths[2].fate, Fate::found);
  EXPECT_EQ(s.truths[3].fate, Fate::found);
  EXPECT_TRUE(s.truths[3].truth.whole);
  EXPECT_EQ(s.sensors.back().false_alarms, 0u);
  EXPECT_NEAR(*s.truths[3].errors.across_px, 0.0, 0.1);
  EXPECT_NEAR(*s.truths[3].errors.flux, 0.0, 0.1);
  EXPECT_FALSE(s.truths[3].errors.start_time_s);  // a table does not say which end came first
}

TEST_F(ForeignFrames, DirectoryWithoutFramesIsRefused) {
  Threads threads(1);
  std::ofstream(table) << "file,id,x_px,y_px\n";
  const auto call = [&](const std::string& where) {
    read_frames(where, table, threads, quietly, CalibratedDetector(nullptr));
  };
  EXPECT_THROW(call(directory), ConfigError);
  EXPECT_THROW(call(directory + "/none"), ConfigError);
  std::ofstream(directory + "/broken.fits") << "SIMPLE  = nonsense";
  EXPECT_THROW(call(directory), ConfigError);
}

// A header without any keyword: places are scored, magnitudes and directions are not known.
TEST_F(ForeignFrames, FramesOfAnotherCameraAreScoredByWhatIsKnown) {
  const FrameHeader header = simulated::camera_header(400, 300, 1663.0, 34 * deg, 20.0, false);
  simulated::SimulatedFrame scene(header, 400, 300, 1500.0, 1);
  scene.add_stars(60, 5000, 50000);
  scene.add_streak(230, 175, 60, 2.0, 4e4);
  const CountImage counts = scene.expose();
  std::ofstream(directory + "/a.fits", std::ios::binary)
      << test::encoded({.bitpix = USHORT_IMG,
                        .shape = {400, 300},
                        .values = {counts.pixels.begin(), counts.pixels.end()}});
  const double dx = 30 * std::cos(2.0), dy = 30 * std::sin(2.0);
  std::ofstream(table)
      << "file,id,x_px,y_px,end1_x_px,end1_y_px,end2_x_px,end2_y_px,magnitude,ra_deg,dec_deg\n"
      << "a.fits,1,230,175," << 230 - dx << "," << 175 - dy << "," << 230 + dx << "," << 175 + dy
      << ",9,0,34\n";
  Threads threads(1);
  const ScoreInput in =
      read_frames(directory, table, threads, quietly, CalibratedDetector(nullptr));
  ASSERT_EQ(in.truths.size(), 1u);
  EXPECT_FALSE(in.truths[0].magnitude || in.truths[0].ra_rad);
  EXPECT_EQ(in.frames[0].scale_rad_per_px, 0.0);
  EXPECT_TRUE(in.detections.at(0).unknown.has(FrameFact::zero_point));
  EXPECT_EQ(score(in, {}).truths.at(0).fate, Fate::found);
}

}  // namespace
}  // namespace dmise
