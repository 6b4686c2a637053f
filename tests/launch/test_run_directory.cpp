#include "launch/run_directory.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace dmise {
namespace {

struct RunDirectories : testing::Test {
  RunDirectories() {
    std::string path = testing::TempDir() + "dmise-run-XXXXXX";
    directory = mkdtemp(path.data());
    for (const char* name : {"zulu", "alpha", "mike"}) {
      SensorConfig sensor;
      sensor.name = name;
      scenario.sensors.push_back(sensor);
    }
  }
  ~RunDirectories() override { std::filesystem::remove_all(directory); }

  void write(const std::string& sensor, const std::string& name, const std::string& lines) const {
    std::filesystem::create_directories(directory + "/" + sensor);
    std::ofstream(directory + "/" + sensor + "/" + name) << lines;
  }
  std::string merged(const std::string& name) const {
    std::ostringstream text;
    text << std::ifstream(directory + "/" + name).rdbuf();
    return text.str();
  }

  std::string directory;
  Scenario scenario;
};

/// A line as sensors write it; `place` tells lines of one time and sensor apart.
std::string line(const char* sensor, const char* time, const char* time_ns, int place) {
  return std::string("{\"sensor\":\"") + sensor + "\",\"" + time + "\":" + time_ns +
         ",\"place\":" + std::to_string(place) + "}\n";
}

// docs/architecture.md: sorted by (time, sensor, index). Times as numbers (9 before 10), sensors by
// name whatever their order in the scenario, lines of one sensor and time as it wrote them.
TEST_F(RunDirectories, MergedLinesAreOrderedByTimeAndSensor) {
  for (const auto& [name, time] : {std::pair{"detections.jsonl", "time_ns"},
                                   {"truth.jsonl", "middle_ns"},
                                   {"frames.jsonl", "middle_ns"}}) {
    write("zulu", name, line("zulu", time, "9", 1) + line("zulu", time, "30000000000", 2));
    write("alpha", name,
          line("alpha", time, "10", 2) + line("alpha", time, "10", 1) +
              line("alpha", time, "30000000000", 3));
    write("mike", name,
          line("mike", time, "10", 0) + line("mike", time, "-5", 0) + "{\"sensor\":\"mike\",\"" +
              time + "\":1,\"cut");
    const RunDirectory run(directory, scenario, "digest");
    run.merge_lines();
    EXPECT_EQ(merged(name), line("mike", time, "-5", 0) + line("zulu", time, "9", 1) +
                                line("alpha", time, "10", 2) + line("alpha", time, "10", 1) +
                                line("mike", time, "10", 0) +
                                line("alpha", time, "30000000000", 3) +
                                line("zulu", time, "30000000000", 2))
        << name;
  }
}

}  // namespace
}  // namespace dmise
