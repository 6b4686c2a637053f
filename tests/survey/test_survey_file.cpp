#include "sensors/survey/survey_file.h"

#include "core/base/text_file.h"
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
  const auto back = read_survey(directory, "head", "a", objects);
  ASSERT_TRUE(back);
  EXPECT_EQ(*back, survey);
  EXPECT_FALSE(read_survey(directory, "another head", "a", objects));
  EXPECT_FALSE(read_survey(directory, "head", "a", 1)) << "of another population";
  EXPECT_FALSE(read_survey(directory + "/none", "head", "a", objects));
}

TEST(SurveyFile, WhatIsDamagedIsNotRead) {
  Network network(evening, {zenith_camera("a")});
  const std::string directory = (network.directory / "a").string();
  const std::size_t objects = network.population.roster.objects.size();
  write_survey(directory, "head", network.survey(), *network.scene, network.shells);
  for (const char* name : {"/passes.csv", "/exposures.csv", "/map.csv"}) {
    const std::string path = directory + name, whole = read_text_file(path);
    std::ofstream(path) << whole.substr(0, whole.size() - whole.size() / 3) << "x,\n";
    EXPECT_FALSE(read_survey(directory, "head", "a", objects)) << name;
    std::filesystem::remove(path);
    EXPECT_FALSE(read_survey(directory, "head", "a", objects)) << name;
    std::ofstream(path) << whole;
    EXPECT_TRUE(read_survey(directory, "head", "a", objects)) << name;
  }
  std::string exposures = read_text_file(directory + "/exposures.csv");
  exposures.replace(exposures.find(",-") + 2, 1, "x");  // in an elevation of the Sun
  std::ofstream(directory + "/exposures.csv") << exposures;
  EXPECT_FALSE(read_survey(directory, "head", "a", objects));
}

}  // namespace
}  // namespace dmise
