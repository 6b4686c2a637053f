#pragma once
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "core/base/error.h"
#include "core/config/make_clock.h"

namespace dmise::test {

/// A directory of its own for a scenario and the files that it names.
class ScenarioDirectory : public testing::Test {
 protected:
  std::filesystem::path directory = std::filesystem::path(testing::TempDir()) / "objects";

  void SetUp() override {
    setenv("DMISE_HOME", DMISE_SOURCE_DIR, 1);
    std::filesystem::create_directories(directory);
  }
  void TearDown() override { std::filesystem::remove_all(directory); }

  void write(const std::string& name, const std::string& text) {
    std::ofstream(directory / name) << text;
  }

  /// `objects` are the lines of the list; `place` is where the one sensor stands.
  Scenario load(const std::string& objects,
                const std::string& place = "site: {latitude_deg: 33.777, longitude_deg: -84.398}") {
    write("scenario.yaml",
          "simulation: {start: 2018-01-21T00:15:00Z, duration_s: 60, tick_s: 10}\n"
          "objects:\n" +
              objects + "sensors:\n  - {name: a, " + place +
              ", camera: omnissa, pointing: zenith, exposure_s: 2, cadence_s: 30}\n");
    return load_scenario((directory / "scenario.yaml").string());
  }

  /// The message of the error that `act` throws, from the file's name on; empty if it throws none.
  template <class Act>
  std::string complaint(Act act) {
    try {
      act();
    } catch (const ConfigError& e) {
      std::string message = e.what();
      for (auto at = message.find(directory.string()); at != std::string::npos;
           at = message.find(directory.string()))
        message.erase(at, directory.string().size() + 1);
      return message;
    }
    return "";
  }
};

}  // namespace dmise::test
