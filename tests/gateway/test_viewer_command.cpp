// What viewers send.
#include "nodes/gateway/viewer_command.h"

#include <gtest/gtest.h>

namespace dmise {
namespace {

using Action = ClockCommand::Action;

TEST(ViewerCommand, IsReadFromJson) {
  EXPECT_EQ(parse_viewer_command(R"({"do": "pause"})"),
            ViewerCommand(ClockCommand{Action::pause, 0}));
  EXPECT_EQ(parse_viewer_command(R"({"do": "go-on"})"),
            ViewerCommand(ClockCommand{Action::go_on, 0}));
  EXPECT_EQ(parse_viewer_command(R"({"do": "step"})"),
            ViewerCommand(ClockCommand{Action::step, 1}));
  EXPECT_EQ(parse_viewer_command(R"({"do": "step", "ticks": 1000000})"),
            ViewerCommand(ClockCommand{Action::step, 1000000}));
  EXPECT_EQ(parse_viewer_command(R"({"do": "pace", "factor": 0.1})"),
            ViewerCommand(ClockCommand{.action = Action::pace, .factor = 0.1}));
  EXPECT_EQ(parse_viewer_command(R"({"do": "past", "time_s": -2.5})"),
            ViewerCommand(PastCommand{-2.5}));
  EXPECT_EQ(parse_viewer_command(R"({"do": "live"})"), ViewerCommand(LiveCommand{}));
}

TEST(ViewerCommand, AnythingElseIsRefused) {
  for (const char* text : {"",
                           "null",
                           "[]",
                           "{}",
                           "{",
                           R"({"do": 1})",
                           R"({"do": "abort"})",
                           R"({"do": "end"})",
                           R"({"do": "pause", "tick": 1})",
                           R"({"do": "step", "ticks": 0})",
                           R"({"do": "step", "ticks": -1})",
                           R"({"do": "step", "ticks": 1.5})",
                           R"({"do": "pace"})",
                           R"({"do": "pace", "factor": -1})",
                           R"({"do": "pace", "factor": 1e7})",
                           R"({"do": "pace", "factor": "1"})",
                           R"({"do": "pace", "factor": 1, "ticks": 1})",
                           R"({"do": "step", "ticks": 1000001})",
                           R"({"do": "step", "ticks": 18446744073709551615})",
                           R"({"do": "past"})",
                           R"({"do": "past", "time_s": "1"})",
                           R"({"do": "past", "time_s": 1e999})",
                           R"({"do": "pause"} x)",
                           "{\"do\": \"pa\xff\"}"})
    EXPECT_TRUE(std::holds_alternative<CommandError>(parse_viewer_command(text))) << text;
  EXPECT_TRUE(std::holds_alternative<CommandError>(
      parse_viewer_command(R"({"do": "pause")" + std::string(2000, ' ') + "}")));
  EXPECT_TRUE(std::holds_alternative<CommandError>(parse_viewer_command(std::string(1000, '['))));
}

}  // namespace
}  // namespace dmise
