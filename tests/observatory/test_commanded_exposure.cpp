// The journal of a night: what is written is read, and what no observatory writes is refused.
#include "sensors/observatory/commanded_exposure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "core/base/error.h"
#include "tests/observatory/small_scenario.h"

namespace dmise {
namespace {

using testing::HasSubstr;

CommandedExposure tracked() {
  CommandedExposure e{
      .sensor = "eye", .frame = 1, .start = {12'345'678'901}, .length = {2'000'000'001}};
  e.pointing = {.follows = true,
                .longitude_deg = 83.63308299999,
                .latitude_deg = -5.123456789012345,
                .longitude_rate_deg_per_s = 1e-3,
                .latitude_rate_deg_per_s = -0.1 / 3,
                .reference = {13'000'000'000},
                .roll_deg = 180.0};
  e.window = {2, 2, 1, 2, 10, 8};
  e.temperature_c = -20.0 / 3;
  e.filter = 2;
  e.focus_um = -12.5;
  e.dark = true;
  return e;
}

CommandedExposure standing() {
  CommandedExposure e{
      .sensor = "eye", .frame = 2, .start = {20'000'000'000}, .length = {1'000'000}};
  e.pointing = {.longitude_deg = 359.9, .latitude_deg = 45.5, .roll_deg = -33.3};
  e.window = {1, 1, 0, 0, 32, 24};
  return e;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(CommandedExposure, IsReadAsItWasWritten) {
  const Scenario scenario = small_observatory(testing::TempDir() + "/journal.yaml");
  const std::string path = testing::TempDir() + "/night.jsonl";
  std::ofstream(path) << to_json(tracked()) << "\n" << to_json(standing()) << "\n{\"sensor\"";
  const auto night = read_night(path, scenario);
  ASSERT_EQ(night.size(), 2u);
  EXPECT_EQ(night[0], tracked());
  EXPECT_EQ(night[1], standing());
}

TEST(CommandedExposure, NightsOfEarlierVersionsAreOfTheFirstFilterInFocus) {
  const Scenario scenario = small_observatory(testing::TempDir() + "/earlier.yaml");
  const std::string path = testing::TempDir() + "/earlier.jsonl";
  std::ofstream(path) << replaced(to_json(tracked()),
                                  ",\"filter\":2,\"focus_um\":-12.5,\"dark\":true", "")
                      << "\n";
  const CommandedExposure e = read_night(path, scenario).at(0);
  EXPECT_EQ(e.filter, 0);
  EXPECT_EQ(e.focus_um, 0.0);
  EXPECT_FALSE(e.dark);
}

TEST(CommandedExposure, RefusesWhatNoObservatoryWrites) {
  const Scenario scenario = small_observatory(testing::TempDir() + "/refused.yaml");
  const std::string path = testing::TempDir() + "/refused.jsonl", line = to_json(tracked());
  for (const auto& [text, reason] : std::vector<std::pair<std::string, std::string>>{
           {replaced(line, "\"eye\"", "\"ear\""), "sensor"},
           {replaced(line, "\"frame\":1", "\"frame\":2"), "must be 1"},
           {replaced(line, "2000000001", "0"), "exposure_ns"},
           {replaced(line, "12345678901", "-5"), "start_ns"},
           {replaced(line, "12345678901", "9000000000000000000"), "start_ns"},
           {replaced(line, "83.63308299999", "400"), "ra_deg"},
           {replaced(line, "13000000000", "130000000000"), "reference_ns"},
           {replaced(line, "[1,2,10,8]", "[1,2,10,80]"), "window"},
           {replaced(line, "[1,2,10,8]", "[1,2,1e300,8]"), "window"},
           {replaced(line, "\"gain\":0", "\"gain\":1"), "gain"},
           {replaced(line, "\"bin\":[2,2]", "\"bin\":[0,2]"), "window"},
           {replaced(line, "\"filter\":2", "\"filter\":3"), "must be 0 to 2"},
           {replaced(line, "\"focus_um\":-12.5", "\"focus_um\":1e6"), "focus_um"},
           {replaced(line, "\"dark\":true", "\"dark\":1"), "dark"},
           {"{}", "sensor"},
           {"[]", ""}}) {
    std::ofstream(path) << text << "\n";
    try {
      read_night(path, scenario);
      ADD_FAILURE() << text;
    } catch (const ConfigError& error) {
      EXPECT_THAT(error.what(), HasSubstr("refused.jsonl:1"));
      EXPECT_THAT(error.what(), HasSubstr(reason));
    }
  }
}

// A pointing's rates count from the start of the run; at its reference it is where it was told.
TEST(CommandedExposure, PointsTheSensorAtItsReference) {
  const CommandedExposure e = tracked();
  const SensorConfig sensor = commanded_sensor(SensorConfig{}, e);
  const auto& sky = std::get<PointSky>(sensor.pointing);
  const double t_s = e.pointing.reference.seconds();
  EXPECT_NEAR(sky.ra_deg + sky.ra_rate_deg_per_s * t_s, e.pointing.longitude_deg, 1e-10);
  EXPECT_NEAR(sky.dec_deg + sky.dec_rate_deg_per_s * t_s, e.pointing.latitude_deg, 1e-10);
  EXPECT_EQ(sensor.tracking, Tracking::moving);
  EXPECT_EQ(commanded_sensor(SensorConfig{}, standing()).tracking, Tracking::fixed);
}

}  // namespace
}  // namespace dmise
