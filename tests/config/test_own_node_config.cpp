#include "core/config/objects/own_node_config.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "core/config/scenario.h"
#include "core/config/schema.h"
#include "core/config/yaml/yaml_reader.h"
#include "tests/support/config_error.h"

namespace dmise {
namespace {

using test::config_error_of;
using testing::HasSubstr;

std::vector<OwnNode> read(const std::string& text, OwnNodeModels models = OwnNodeModels::programs) {
  YamlMap map(YamlValue::parse("nodes: " + text, "s.yaml"), scenario_section());
  return read_own_nodes(map.require("nodes"), models);
}
std::string complaint(const std::string& text) {
  return config_error_of([&] { read(text); });
}

TEST(OwnNodeConfig, ANodeIsItsProgramAndWhatThatIsTold) {
  const OwnNode node =
      read(
          "[{name: gnc, run: [sh, -c, exit], period_ticks: 3, options: {gain: 0.3, deep: [1, x], "
          "loud: on, quoted: \"1\"}}]")
          .at(0);
  EXPECT_EQ(node.name, "gnc");
  EXPECT_THAT(node.run, testing::ElementsAre("sh", "-c", "exit"));
  EXPECT_EQ(node.period_ticks, 3);
  EXPECT_EQ(node.options_json, R"({"gain":0.3,"deep":[1,"x"],"loud":true,"quoted":"1"})");
  EXPECT_EQ(command_text(node), "sh -c exit");
  const OwnNode other = read("[{name: other, elsewhere: on}]").at(0);
  EXPECT_TRUE(other.run.empty());
  EXPECT_EQ(other.options_json, "{}");
}

TEST(OwnNodeConfig, WhatIsWrongIsToldWithItsPlace) {
  EXPECT_THAT(complaint("[{name: gnc}]"), HasSubstr("s.yaml:1:9: nodes[0]: give either run or"));
  EXPECT_THAT(complaint("[{name: gnc, run: [sh], elsewhere: on}]"), HasSubstr("give either run"));
  EXPECT_THAT(complaint("[{name: gnc, run: []}]"), HasSubstr("nodes[0].run: needs a program"));
  EXPECT_THAT(complaint("[{name: gnc, run: [no-such-program]}]"),
              HasSubstr("nodes[0].run[0]: there is no such program, got no-such-program"));
  EXPECT_THAT(complaint("[{name: gnc, run: [./s.yaml]}]"), HasSubstr("there is no such program"));
  EXPECT_THAT(complaint("[{name: gnc, run: [sh, -x, gone.py]}]"),
              HasSubstr("nodes[0].run[2]: there is no such file in "));
  EXPECT_THAT(complaint("[{name: gnc, run: [sh], period_ticks: 0}]"),
              HasSubstr("nodes[0].period_ticks: must be >= 1, got 0"));
  EXPECT_THAT(complaint("[{name: gnc, run: [sh], options: {a: {b: 1}}}]"),
              HasSubstr("nodes[0].options.a: must be a number, a flag, a text"));
  EXPECT_THAT(complaint("[{name: gnc, ran: [sh]}]"), HasSubstr("did you mean run?"));
}

TEST(OwnNodeConfig, AFunctionNeedsNoProgramAndIgnoresIt) {
  for (const char* text :
       {"[{name: a}]", "[{name: a, run: [/none/such]}]", "[{name: a, elsewhere: on}]"}) {
    const OwnNode node = read(text, OwnNodeModels::functions).at(0);
    EXPECT_TRUE(node.is_function);
    EXPECT_TRUE(node.run.empty());
  }
  EXPECT_FALSE(read("[{name: a, elsewhere: on}]").at(0).is_function);
  EXPECT_THAT(config_error_of(
                  [] { read("[{name: a, fmu: a.fmu, outputs: {}}]", OwnNodeModels::functions); }),
              HasSubstr("an FMU is no function of this process"));
}

TEST(OwnNodeConfig, ProgramsNeedLeave) {
  EXPECT_EQ(config_error_of([] { refuse_programs(read("[{name: a, elsewhere: on}]")); }),
            "no error");
  EXPECT_THAT(config_error_of([] {
                refuse_programs(read("[{name: a, elsewhere: on}, {name: b, run: [sh, x]}]"));
              }),
              testing::AllOf(HasSubstr("nodes[1].run: the scenario starts `sh x`"),
                             HasSubstr("--allow-programs")));
}

// The digest of a run covers the program and those of its arguments that are files.
TEST(OwnNodeConfig, ItsFilesAreProgramAndArguments) {
  const auto directory = std::filesystem::path(testing::TempDir()) / "own-node";
  std::filesystem::create_directories(directory);
  std::ofstream(directory / "model.sh") << "exit\n";
  OwnNode node{.name = "gnc",
               .where = "",
               .run = {"sh", "model.sh", "--fast"},
               .run_where = "",
               .directory = directory.string()};
  const auto files = files_of({node});
  ASSERT_EQ(files.size(), 2u);
  EXPECT_EQ(files[0], program_of(node));
  EXPECT_THAT(files[0], testing::EndsWith("/sh"));
  EXPECT_EQ(files[1], (directory / "model.sh").string());
  node.run = {"./model.sh"};
  EXPECT_EQ(program_of(node), "");  // may not be executed
  std::filesystem::permissions(directory / "model.sh", std::filesystem::perms::owner_all);
  EXPECT_EQ(program_of(node), (directory / "./model.sh").string());
  std::filesystem::remove_all(directory);
}

}  // namespace
}  // namespace dmise
