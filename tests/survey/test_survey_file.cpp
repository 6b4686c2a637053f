#include "sensors/survey/survey_file.h"

#include "core/base/files/text_file.h"
#include "tests/survey/network.h"

namespace dmise {
namespace {

using test::evening;
using test::Network;
using test::zenith_camera;

TEST(SurveyFile, ReadsBackToTheSameBits) {
  Network network(evening, {zenith_camera("a")});
  const SensorSurvey survey = network.survey();
  const std::string directory = (network.directory / "a").string();
  const std::size_t objects = network.population.roster.objects.size();
  write_survey(directory, "head", survey, *network.scene, network.shells);
  bool damaged = true;
  const auto read = [&](const std::string& from, const char* head, std::size_t count) {
    return read_survey(from, head, "a", count, damaged);
  };
  const auto back = read(directory, "head", objects);
  ASSERT_TRUE(back);
  EXPECT_EQ(*back, survey);
  EXPECT_FALSE(damaged);
  EXPECT_FALSE(read(directory, "another head", objects));
  EXPECT_FALSE(damaged);
  EXPECT_FALSE(read(directory, "head", 1)) << "of another population";
  EXPECT_FALSE(read(directory + "/none", "head", objects));
  EXPECT_FALSE(damaged);
}

TEST(SurveyFile, WhatIsDamagedIsNotRead) {
  Network network(evening, {zenith_camera("a")});
  const std::string directory = (network.directory / "a").string();
  const std::size_t objects = network.population.roster.objects.size();
  write_survey(directory, "head", network.survey(), *network.scene, network.shells);
  bool damaged = false;
  const auto read = [&] { return read_survey(directory, "head", "a", objects, damaged); };
  for (const char* name : {"/passes.csv", "/exposures.csv", "/map.csv"}) {
    const std::string path = directory + name, whole = read_text_file(path);
    std::ofstream(path) << whole.substr(0, whole.size() - whole.size() / 3) << "x,\n";
    EXPECT_FALSE(read()) << name;
    EXPECT_TRUE(damaged) << name;
    // Cut between two rows, and a row that is there twice.
    const std::size_t last_row = whole.rfind('\n', whole.size() - 2) + 1;
    std::ofstream(path) << whole.substr(0, last_row);
    EXPECT_FALSE(read()) << name;
    EXPECT_TRUE(damaged) << name;
    std::ofstream(path) << whole << whole.substr(last_row);
    EXPECT_FALSE(read()) << name;
    std::filesystem::remove(path);
    EXPECT_FALSE(read()) << name;
    EXPECT_TRUE(damaged) << name;
    std::ofstream(path) << whole;
    EXPECT_TRUE(read()) << name;
    EXPECT_FALSE(damaged) << name;
  }
  std::string exposures = read_text_file(directory + "/exposures.csv");
  exposures.replace(exposures.find(",-") + 2, 1, "x");  // in an elevation of the Sun
  std::ofstream(directory + "/exposures.csv") << exposures;
  EXPECT_FALSE(read());
}

}  // namespace
}  // namespace dmise
