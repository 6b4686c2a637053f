#include "launch/run/run_directory.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/base/error.h"

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

TEST_F(RunDirectories, ClearingRemovesProductsAndNothingElse) {
  const std::string sensor_line = R"({"sensor":"old","frame":1,"start_ns":0})"
                                  "\n";
  for (const char* product :
       {"frames.jsonl", "detections.jsonl", "truth.jsonl", "cost.jsonl", "tasks.journal",
        "frame-000001.fits", "frame-1234567.fits.partial", "frame-000001-sources.fits",
        "frame-000001-background.fits", "frame-000001-noise.fits", "frame-000001-radiance.exr",
        "frame-000001.png", "frame-000001-marked.png", "frame-000001.stars.csv"})
    for (const char* sensor : {"alpha", "old"}) write(sensor, product, sensor_line);
  write("fusion-node", "inputs.journal", "1");
  write("positions", "ISS-25544.oem", "1");
  write("", "index.html", "1");
  write("", "run.json", R"({"status":"complete","digest":"another"})");

  const std::vector<std::pair<std::string, std::string>> others = {
      {"alpha", "thesis.txt"},       {"alpha", "frame-000001.txt"},
      {"alpha", "frame-.fits"},      {"positions", "ISS.oem"},
      {"first", "run.json"},         {"first", "frames.jsonl"},
      {"someone", "frames.jsonl"},   {"", "notes.txt"},
      {"first/old", "frames.jsonl"}, {"alpha/deep", "frames.jsonl"}};
  for (const auto& [where, name] : others) write(where, name, sensor_line);

  RunDirectory run(directory, scenario, "digest");
  EXPECT_EQ(run.content(), RunDirectory::Content::another_run);
  run.clear(true);
  EXPECT_EQ(run.content(), RunDirectory::Content::half_cleared);
  std::size_t left = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(directory))
    left += entry.is_regular_file() && !entry.path().filename().string().starts_with(".run-lock");
  EXPECT_EQ(left, others.size() + 1);  // run.json
  for (const auto& [where, name] : others)
    EXPECT_TRUE(std::filesystem::exists(directory + "/" + where + "/" + name)) << where << name;
  EXPECT_FALSE(std::filesystem::exists(directory + "/old"));
  EXPECT_FALSE(std::filesystem::exists(directory + "/fusion-node"));
}

// Repeated unasked: what the run of this scenario wrote, and nothing of sensors that it lacks.
TEST_F(RunDirectories, ClearingItsOwnLeavesWhatOthersHave) {
  const std::string old = "{\"sensor\":\"old\",\"frame\":1,\"start_ns\":0}\n";
  write("old", "frames.jsonl", old);
  write("positions", "ISS-25544.oem", "1");
  write("fusion-node", "run.json", "{}");
  write("fusion-node", "tracks.jsonl", "1");
  write("alpha", "frame-000001.fits", "1");
  write("", "run.json", R"({"status":"begun","dropped":[],"digest":"digest"})");
  RunDirectory run(directory, scenario, "digest");
  EXPECT_FALSE(run.lacks_nodes());
  run.clear(false);
  EXPECT_FALSE(std::filesystem::exists(directory + "/alpha"));
  for (const char* name :
       {"/old/frames.jsonl", "/positions/ISS-25544.oem", "/fusion-node/tracks.jsonl"})
    EXPECT_TRUE(std::filesystem::exists(directory + name)) << name;
  write("", "run.json", R"({"status":"incomplete","dropped":["alpha"],"digest":"digest"})");
  EXPECT_TRUE(run.lacks_nodes());
}

TEST_F(RunDirectories, FilesWithoutARunAreInTheWay) {
  const RunDirectory run(directory, scenario, "digest");
  write("first", "run.json", "{}");
  write("", "notes.txt", "");
  std::filesystem::create_directory(directory + "/alpha");
  EXPECT_EQ(run.in_the_way(), "");
  write("alpha", "thesis.txt", "");
  EXPECT_EQ(run.in_the_way(), directory + "/alpha");
  write("", "index.html", "");
  EXPECT_EQ(run.in_the_way(), directory + "/index.html");
}

TEST_F(RunDirectories, NoSensorWritesIntoTheDirectoryOfARun) {
  const RunDirectory run(directory, scenario, "digest");
  run.check_sensor_directories();
  write("mike", "run.json", "{}");
  EXPECT_THROW(run.check_sensor_directories(), ConfigError);
}

// A run with dropped nodes, or ended early, goes on.
TEST_F(RunDirectories, OnlyACompleteRunIsComplete) {
  const RunDirectory run(directory, scenario, "digest");
  for (const char* status : {"begun", "incomplete", "ended", "interrupted", "failed"}) {
    write("", "run.json", std::string(R"({"status":")") + status + R"(","digest":"digest"})");
    EXPECT_EQ(run.content(), RunDirectory::Content::same_run_unfinished) << status;
  }
  write("", "run.json", R"({"status":"complete","digest":"digest"})");
  EXPECT_EQ(run.content(), RunDirectory::Content::same_run_complete);
  write("", "run.json", R"({"status":"complete","digest":"another"})");
  EXPECT_EQ(run.content(), RunDirectory::Content::another_run);
  for (const char* damaged :
       {"", "[1]", R"({"status":"complete","digest":"dig)", R"({"digest":1})"}) {
    write("", "run.json", damaged);
    EXPECT_EQ(run.content(), RunDirectory::Content::unreadable) << damaged;
  }
}

}  // namespace
}  // namespace dmise
