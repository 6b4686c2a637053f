#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "core/base/error.h"
#include "core/report/run_report.h"

namespace dmise {
namespace {

using testing::HasSubstr;
using testing::Not;

const std::string hostile = "</script><script>alert(1)</script><!--";

RunContents run_of(std::size_t sensors, std::uint32_t frames) {
  RunContents run{.directory = "RUN", .record = {.status = "complete"}};
  for (std::size_t s = 0; s < sensors; ++s) {
    run.sensors.push_back({.sensor = {.name = hostile + std::to_string(s)}, .frames = frames});
    for (std::uint32_t f = 1; f <= frames; ++f)
      run.frames.push_back({.sensor = s, .number = f, .middle = {f * 1'000'000'000ll}});
  }
  return run;
}

std::size_t count(const std::string& text, const std::string& of) {
  std::size_t n = 0;
  for (auto at = text.find(of); at != std::string::npos; at = text.find(of, at + 1)) ++n;
  return n;
}

TEST(RunReport, KeepsNamesOutOfItsMarkup) {
  Threads threads;
  const std::string page = run_report(run_of(1, 1), nullptr, threads);
  EXPECT_THAT(page, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(page, HasSubstr("\\u003c/script>"));
  EXPECT_EQ(count(page, "</script>"), 2u);  // the data's end and the script's
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
  EXPECT_THAT(page, Not(HasSubstr("unsafe-inline")));
  EXPECT_EQ(count(page, "://"), 1u);  // the name of SVG's vocabulary
}

TEST(RunReport, StaysSmallForManySensorsAndFrames) {
  Threads threads;
  const std::string page = run_report(run_of(200, 500), nullptr, threads);  // 100,000 frames
  EXPECT_LT(page.size(), 4'000'000u);
  EXPECT_THAT(page, HasSubstr("\"frame_count\":100000"));
}

TEST(RunReport, IsTheSameForTheSameRun) {
  Threads one, many(4);
  EXPECT_EQ(run_report(run_of(3, 5), nullptr, one), run_report(run_of(3, 5), nullptr, many));
}

TEST(RunReport, RefusesADirectoryWithoutARun) {
  const std::string empty = testing::TempDir() + "/no-run";
  std::filesystem::create_directory(empty);
  EXPECT_THROW(read_contents(empty), ConfigError);
  std::filesystem::remove(empty);
}

}  // namespace
}  // namespace dmise
