#include "nodes/runtime/program/command_line.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "nodes/runtime/program/program.h"

namespace dmise {
namespace {

using testing::EndsWith;
using testing::HasSubstr;

TEST(NumberBetween, TakesItsRangeAndNoNan) {
  const CLI::Validator check = number_between(0.5, 2e3);
  for (std::string good : {"0.5", "1", "2e3", "2000.0"}) EXPECT_EQ(check(good), "") << good;
  for (std::string bad : {"nan", "NaN", "-nan", "inf", "-inf", "0.49", "2001", "x", ""})
    EXPECT_NE(check(bad), "") << bad;
}

TEST(Addresses, OfSocketsAreTaken) {
  for (const char* good : {"tcp://127.0.0.1:7998", "tcp://127.0.0.1:0", "tcp://*:5",
                           "tcp://[::1]:5", "tcp://time-master:7660", "tcp://10.0.0.1:*",
                           "ipc:///tmp/x", "ipc://@x", "inproc://x", "tcp://h:65535"})
    EXPECT_EQ(address_error(good), "");
}

TEST(Addresses, WithoutTheirTransportAreShownWithIt) {
  EXPECT_EQ(address_error("127.0.0.1:7998"),
            "must be tcp://HOST:PORT, did you mean tcp://127.0.0.1:7998?, got 127.0.0.1:7998");
  for (const char* near : {"localhost:7998", "tcp:localhost:7998", "tcp:/localhost:7998",
                           "http://localhost:7998", "//localhost:7998", "udp://localhost:7998"})
    EXPECT_THAT(address_error(near), HasSubstr("did you mean tcp://localhost:7998?"));
  EXPECT_THAT(address_error("[::1]:7"), HasSubstr("tcp://[::1]:7?"));
  for (const char* bad :
       {"", "7998", "127.0.0.1", "tcp://127.0.0.1", "tcp://127.0.0.1:", "tcp://:7", "tcp://h:65536",
        "tcp://h:-1", "tcp://h:7x", "tcp://a b:7", "ipc://", "tcp://a:b:7", "tcp://"}) {
    EXPECT_THAT(address_error(bad), HasSubstr("must be tcp://HOST:PORT")) << bad;
    EXPECT_THAT(address_error(bad), EndsWith(std::string("got ") + bad));
  }
}

struct CommandLine : testing::Test {
  CommandLine() {
    app.require_subcommand(1);
    CLI::App* run = app.add_subcommand("run", "");
    run->add_option("scenario", scenario, "")->required();
    run->add_option("--threads", threads, "");
    app.add_subcommand("check", "")->add_option("scenario", scenario, "")->required();
    CLI::App* clock = app.add_subcommand("clock", "");
    clock->require_subcommand(1);
    clock->add_subcommand("pause", "");
  }

  /// What is said of a command line, and its exit code.
  std::string said(std::vector<std::string> arguments) {
    std::reverse(arguments.begin(), arguments.end());
    testing::internal::CaptureStderr();
    int code = 0;
    try {
      app.parse(arguments);
    } catch (const CLI::ParseError& error) {
      code = end_of_command_line(app, error);
    }
    return std::to_string(code) + " " + testing::internal::GetCapturedStderr();
  }

  CLI::App app{"", "dmise"};
  std::string scenario;
  int threads = 1;
};

TEST_F(CommandLine, SuggestsCommandsAndOptions) {
  EXPECT_EQ(said({"chek"}), "2 dmise: unknown command chek, did you mean check? (dmise --help)\n");
  EXPECT_EQ(said({"chek", "a.yaml", "--threads", "2"}),
            "2 dmise: unknown option --threads (dmise --help)\n");
  EXPECT_EQ(said({"clock", "paus"}),
            "2 dmise clock: unknown command paus, did you mean pause? (dmise clock --help)\n");
  EXPECT_EQ(said({"telescope"}), "2 dmise: unknown command telescope (dmise --help)\n");
  for (const auto& line : {std::vector<std::string>{"run", "a.yaml", "--thread", "2"},
                           {"run", "--thread", "2", "a.yaml"},
                           {"run", "--thread=2", "a.yaml"},
                           {"run", "--thread"}})
    EXPECT_EQ(said(line),
              "2 dmise run: unknown option --thread, did you mean --threads? (dmise run --help)\n");
  EXPECT_EQ(said({"run", "a.yaml", "b.yaml"}),
            "2 dmise run: unexpected argument b.yaml (dmise run --help)\n");
  EXPECT_EQ(said({"run"}), "2 dmise run: scenario is required (dmise run --help)\n");
}

TEST_F(CommandLine, OfEveryProgramSuggestsAndNamesTheTransport) {
  CommonFlags flags;
  CLI::App program("", "dmise-broker");
  add_common_flags(program, flags);
  const auto run = [&](std::vector<const char*> arguments) {
    arguments.insert(arguments.begin(), "dmise-broker");
    testing::internal::CaptureStderr();
    const int code = run_program(program, flags, int(arguments.size()),
                                 const_cast<char**>(arguments.data()), [] { return 0; });
    return std::to_string(code) + " " + testing::internal::GetCapturedStderr();
  };
  EXPECT_THAT(run({"--nam", "x"}),
              testing::StartsWith("2 dmise-broker: unknown option --nam, did you mean --name?"));
  for (const char* option : {"--master", "--host"})
    EXPECT_THAT(run({option, "127.0.0.1:7998"}), HasSubstr("did you mean tcp://127.0.0.1:7998?"));
}

}  // namespace
}  // namespace dmise
