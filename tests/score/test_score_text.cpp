#include "core/score/score_text.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/score/score_charts.h"
#include "tests/score/sources.h"

namespace dmise {
namespace {

using test::found;
using test::frame;
using test::source;

Score small_score() {
  ScoreInput in{.source = "hand-made", .status = "interrupted", .frames = {frame("1"), frame("2")}};
  in.frames.push_back(frame("3"));
  in.frames.back().searched = false;
  in.truths = {source("\"GOES\", 13", {100, 100}, {200, 100}),
               source("lost", {300, 300}, {400, 300})};
  in.detections = {found(0, {100, 100.5}, {200, 100.5}), found(1, {700, 700}, {700, 700})};
  return score(in, {});
}

TEST(ScoreText, JsonHoldsTheFigures) {
  const auto json = nlohmann::json::parse(score_json(small_score()));
  const auto& total = json["total"];
  EXPECT_EQ(json["status"], "interrupted");
  EXPECT_EQ(json["sensors"].size(), 1u);
  EXPECT_EQ(json["sensors"][0]["sensor"], "eye");
  EXPECT_EQ(total["found"], 1);
  EXPECT_EQ(total["missed"], 1);
  EXPECT_EQ(total["false_alarms"], 1);
  EXPECT_EQ(total["false_alarms_per_frame"], 0.5);
  EXPECT_NEAR(total["false_alarms_per_megapixel"].get<double>(), 1 / 1.6, 1e-12);
  EXPECT_NEAR(total["detection"]["low"].get<double>(), 0.094531, 1e-6);  // Wilson, 1 of 2
  EXPECT_NEAR(total["errors"]["streaks"]["across_px"]["rms"].get<double>(), 0.5, 1e-9);
  EXPECT_NEAR(total["errors"]["streaks"]["nees_px"]["mean"].get<double>(), 12.5, 1e-6);
  EXPECT_NEAR(total["errors"]["streaks"]["nees_px"]["honest"][1].get<double>(), 3.688879, 1e-6);
  EXPECT_TRUE(total["errors"]["points"]["across_px"]["rms"].is_null());
  EXPECT_EQ(json["missed"][0]["id"], "lost");
  EXPECT_EQ(json["false"][0]["id"], "eye/1/1");
}

TEST(ScoreText, CsvHasARowForEachTruthAndFalseAlarm) {
  const std::string csv = score_csv(small_score());
  EXPECT_EQ(std::ranges::count(csv, '\n'), 4);
  EXPECT_NE(csv.find("eye,1,found,\"\"\"GOES\"\", 13\",eye/1/0,1,1,"), std::string::npos) << csv;
  EXPECT_NE(csv.find("\neye,1,missed,lost,,0,0,"), std::string::npos) << csv;
  EXPECT_NE(csv.find("\neye,1,false,,eye/1/1,1,0,"), std::string::npos) << csv;
  std::size_t begin = csv.find('\n') + 1;
  const auto commas = std::count(csv.begin(), csv.begin() + long(begin), ',');
  EXPECT_EQ(std::count(csv.begin() + long(csv.find("eye,1,missed")),
                       csv.begin() + long(csv.find("eye,1,false")), ','),
            commas);
  EXPECT_EQ(std::count(csv.begin() + long(csv.find("eye,1,false")), csv.end(), ','), commas);
}

TEST(ScoreText, TableSaysThatARunIsNotComplete) {
  const std::string table = score_table(small_score());
  EXPECT_EQ(table.rfind("hand-made: the run is not complete: interrupted\n", 0), 0u);
  EXPECT_NE(table.find("lost"), std::string::npos);
  EXPECT_NE(table.find("eye/1/1"), std::string::npos);
}

// Names in files are anybody's: none reaches a terminal with its control characters.
TEST(ScoreText, TableIsSafeToPrint) {
  ScoreInput in{.frames = {frame()}, .truths = {source("\x1b[2J\n", {300, 300}, {400, 300})}};
  const std::string table = score_table(score(in, {}));
  EXPECT_EQ(table.find('\x1b'), std::string::npos);
  EXPECT_NE(table.find("\\x1b[2J\\n"), std::string::npos);
}

TEST(ScoreCharts, AreDrawnOfAnyScore) {
  for (const Score& s : {small_score(), score(ScoreInput{}, {})})
    for (const Chart& chart : {detection_chart(s), position_chart(s), magnitude_chart(s)}) {
      const std::string svg = chart_svg(chart);
      EXPECT_EQ(svg.rfind("<svg", 0), 0u);
      EXPECT_EQ(svg.find("nan"), std::string::npos);
      EXPECT_EQ(svg.find("inf"), std::string::npos);
    }
}

// The detection of `small_score` is 60 bounds off.
TEST(ScoreCharts, WhatIsBeyondTheAxisIsAtItsEnd) {
  const Chart chart = position_chart(small_score());
  ASSERT_EQ(chart.series[0].lines.size(), 2u);  // a cross
  EXPECT_EQ(chart.series[0].lines[0][0].y, chart.y.most);
}

// The theory passes one half at the threshold.
TEST(ScoreCharts, TheoryPassesTheThreshold) {
  const Chart chart = detection_chart(small_score());
  for (const ChartPoint& p : chart.series[0].lines[0])
    if (std::abs(p.x - 6.0) < 0.03) {
      EXPECT_NEAR(p.y, 0.5, 0.02);
    }
}

}  // namespace
}  // namespace dmise
