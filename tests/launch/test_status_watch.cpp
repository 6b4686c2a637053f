#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "launch/process/status_watch.h"

namespace dmise {
namespace {

using testing::HasSubstr;
using testing::Not;

RunStatus run_of(Tick alpha, Tick beta) {
  RunStatus status{.run_id = 1, .phase = Phase::running, .last_tick = 100};
  status.tick_length = sim_seconds(5.0);
  status.settled = std::min(alpha, beta);
  status.nodes = {{.name = "alpha", .done = alpha}, {.name = "beta", .done = beta}};
  status.holding = {"beta"};
  return status;
}

std::string line_of(const std::string& table, const std::string& name) {
  std::istringstream text(table);
  for (std::string line; std::getline(text, line);)
    if (line.starts_with(name)) return line;
  return "";
}

TEST(StatusWatch, TellsTimeRateAndLag) {
  StatusWatch watch;
  watch.take(run_of(10, 8), 100.0);
  watch.take(run_of(14, 9), 102.0);
  const std::string table = watch.table({.columns = 120});
  // 4 ticks of 5 s in 2 s; 1 tick in 2 s, and 5 ticks behind.
  EXPECT_THAT(line_of(table, "alpha"), HasSubstr("0:01:10.0"));
  EXPECT_THAT(line_of(table, "alpha"), HasSubstr(" 10x "));
  EXPECT_THAT(line_of(table, "beta"), HasSubstr("awaited"));
  EXPECT_THAT(line_of(table, "beta"), HasSubstr(" 2.5x "));
  EXPECT_THAT(line_of(table, "beta"), HasSubstr(" 25 s "));
}

TEST(StatusWatch, HasNoRateAndNoLagForNodesWithoutTicks) {
  StatusWatch watch;
  for (const double now_s : {100.0, 102.0}) {
    RunStatus status = run_of(10, 10);
    status.nodes.push_back({.name = "broker", .done = -1});
    watch.take(status, now_s);
  }
  EXPECT_THAT(line_of(watch.table({.columns = 120}), "broker"), Not(HasSubstr("0x")));
  EXPECT_THAT(line_of(watch.table({.columns = 120}), "broker"), Not(HasSubstr(" s ")));
}

TEST(StatusWatch, TellsGapsAndTheLastError) {
  StatusWatch watch;
  RunStatus status = run_of(10, 10);
  watch.take(status, 1.0);
  status.nodes[1].alive = false;
  watch.take(status, 2.0);
  EXPECT_THAT(line_of(watch.table({.columns = 120}), "beta"), HasSubstr("1  lost at 0:00:50.0"));
  status.nodes[1].alive = true;
  status.nodes[1].incarnation = 2;
  watch.take(status, 3.0);
  EXPECT_THAT(line_of(watch.table({.columns = 120}), "beta"),
              HasSubstr("2  restarted at 0:00:50.0"));
  watch.miss("no answer", 7.0);
  EXPECT_THAT(watch.table({.columns = 120}), HasSubstr("no answer for 4 s"));
}

TEST(StatusWatch, FitsTheTerminal) {
  StatusWatch watch;
  RunStatus status = run_of(1, 1);
  status.nodes.clear();
  for (int k = 0; k < 300; ++k)
    status.nodes.push_back({.name = "a-sensor-with-a-long-name-" + std::to_string(k), .done = 1});
  status.cause = std::string(500, 'x') + "\x1b[31m";
  watch.take(status, 1.0);
  for (const int columns : {20, 40, 80, 200})
    for (const int rows : {1, 10, 24, 80}) {
      std::istringstream text(watch.table({.columns = columns, .rows = rows}));
      int lines = 0;
      for (std::string line; std::getline(text, line); ++lines)
        EXPECT_LE(line.size(), std::size_t(columns));
      EXPECT_LE(lines, std::max(rows, 7));
    }
  EXPECT_THAT(watch.table({.columns = 80, .rows = 24}), HasSubstr("more nodes"));
  // No control character of others reaches the terminal.
  EXPECT_THAT(watch.table({.columns = 700, .rows = 24}), Not(HasSubstr("\x1b")));
}

TEST(StatusWatch, ColoursOnlyWhereTheyAreWanted) {
  StatusWatch watch;
  watch.take(run_of(1, 1), 1.0);
  EXPECT_THAT(watch.table({.colours = true}), HasSubstr("\x1b[32m"));
  EXPECT_THAT(watch.table({.colours = false}), Not(HasSubstr("\x1b")));
  EXPECT_TRUE(wants_colours(true, nullptr, "xterm"));
  EXPECT_TRUE(wants_colours(true, "", "xterm"));  // no-color.org: not an empty one
  EXPECT_FALSE(wants_colours(true, "1", "xterm"));
  EXPECT_FALSE(wants_colours(false, nullptr, "xterm"));
  EXPECT_FALSE(wants_colours(true, nullptr, "dumb"));
  EXPECT_FALSE(wants_colours(true, nullptr, nullptr));
}

}  // namespace
}  // namespace dmise
