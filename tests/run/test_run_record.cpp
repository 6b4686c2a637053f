#include "core/run/run_record.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "core/base/error.h"
#include "core/run/run_files.h"

namespace dmise {
namespace {

struct RunRecords : testing::Test {
  RunRecords() { std::filesystem::create_directory(directory); }
  ~RunRecords() override { std::filesystem::remove_all(directory); }
  void write(const std::string& text) const {
    std::ofstream(path_in(directory, run_file::record)) << text;
  }
  std::string refusal() const {
    try {
      ended_run_record(directory);
    } catch (const ConfigError& error) {
      return std::string(error.what()).substr(directory.size() + 1);
    }
    return "none";
  }
  std::string directory = testing::TempDir() + "/run-record";
};

TEST_F(RunRecords, ADirectoryWithoutARunHasNone) {
  EXPECT_FALSE(read_run_record(directory));
  EXPECT_EQ(refusal(), "run.json: is missing: no run, or one that has not ended");
}

TEST_F(RunRecords, OfARunThatHasBegunIsItsMark) {
  write(R"({"status":"begun","digest":"abc","parts":3,"wall_s":1.5})");
  const auto record = read_run_record(directory);
  ASSERT_TRUE(record);
  EXPECT_EQ(record->status + record->digest, "begunabc");
  EXPECT_EQ(record->parts, 3);
  EXPECT_EQ(record->wall_s, 1.5);
  EXPECT_TRUE(record->sensors.empty());
  EXPECT_EQ(refusal(),
            "run.json: status: the run has not ended, or was refused at its start: got begun");
}

TEST_F(RunRecords, HasSensorsCataloguesAndObjects) {
  write(R"({"status":"incomplete","dropped":["eye"],"software":"dmise","digest":"d","seed":7,
"catalogue_sha256":["ff"],"scenario":{
"simulation":{"start":"2018-01-21T00:15:00Z","duration_ns":2000000000,"tick_ns":1000000000,
"ellipsoid":{"a_m":6378137,"f":0.003}},
"sensors":[{"name":"eye","site":{"latitude_deg":1,"longitude_deg":2,"height_m":3},"exposure_s":2,
"camera":{"name":"lens","columns":64,"rows":48,"psf_fwhm_px":2,"aperture_m":0.1,
"focal_length_m":0.1,"pixel_pitch_m":5e-6,"band_centre_m":5.5e-7},"effects":["light_time!"]},
{"name":"ear","platform":"sat","node":"radar"}],
"objects":[{"catalogue":"demo","only":["ISS"]},{"name":"mine","catalogue_number":5}]}})");
  const RunRecord run = ended_run_record(directory);
  EXPECT_EQ(run.dropped, std::vector<std::string>{"eye"});
  EXPECT_EQ(run.seed, 7u);
  EXPECT_EQ(run.duration, SimTime{2000000000});
  ASSERT_EQ(run.sensors.size(), 2u);
  EXPECT_EQ(run.sensors[0].camera, "lens");
  EXPECT_EQ(run.sensors[0].columns, 64);
  EXPECT_TRUE(run.sensors[0].light_time);
  ASSERT_TRUE(run.sensors[0].site);
  EXPECT_EQ(run.sensors[0].site->ellipsoid.flattening, 0.003);
  EXPECT_EQ(run.sensors[1].platform + run.sensors[1].camera, "satnode radar");
  ASSERT_EQ(run.catalogues.size(), 1u);
  EXPECT_EQ(run.catalogues[0].named + run.catalogues[0].sha256, "demoff");
  ASSERT_EQ(run.own_objects.size(), 1u);
  EXPECT_EQ(run.own_objects[0].catalogue_number, 5u);
}

TEST_F(RunRecords, SatellitesOfAConstellationAreObjectsWithElements) {
  const auto record = [](const std::string& planes) {
    return R"({"status":"complete","scenario":{"sensors":[],"objects":[{"walker":"w",
"first_number":990000001,"planes":)" +
           planes + R"(,"per_plane":2,"phasing":1,
"orbit":[7e6,1,6.25,0,0.5,2458139.5,0.25,0],"radius_m":1,"albedo":0.2,"only":[]}]}})";
  };
  write(record("3"));
  const RunRecord run = *read_run_record(directory);
  EXPECT_TRUE(run.catalogues.empty());
  ASSERT_EQ(run.own_objects.size(), 6u);
  EXPECT_EQ(run.own_objects[5].catalogue_number, 990000006u);
  EXPECT_EQ(run.own_objects[5].elements->name, "w-3-2");
  EXPECT_EQ(run.own_objects[5].elements->inclination_rad, 1.0);
  write(record("1000000000"));
  EXPECT_EQ(refusal(),
            "run.json: scenario: objects: planes: a constellation has 1 to 100000 satellites");
}

TEST_F(RunRecords, FragmentsAreObjectsWithElements) {
  const auto record = [](const std::string& min_m) {
    return R"({"status":"complete","seed":7,"scenario":{"simulation":{"start":
"2018-01-21T00:00:00Z","duration_ns":1000000000,"tick_ns":1000000000},"sensors":[],"objects":[
{"breakup":"b","first_number":990000001,"collision":false,"spacecraft":false,
"event":[900,1,0,0,)" +
           min_m + R"(],"teme":[2458138.5,0.75,7158135,0,0,0,468.6,7447.7],
"radius_m":1,"albedo":0.175,"only":[]}]}})";
  };
  write(record("0.2"));
  const RunRecord run = *read_run_record(directory);
  EXPECT_TRUE(run.catalogues.empty());
  ASSERT_GT(run.own_objects.size(), 60u);
  ASSERT_LE(run.own_objects.size(), 78u);  // 6 / 0.2^1.6
  EXPECT_EQ(run.own_objects[5].catalogue_number, 990000006u);
  EXPECT_EQ(run.own_objects[5].elements->name, "b-06");
  EXPECT_EQ(run.own_objects[5].elements->epoch_jd2, 0.75);
  write(record("1e-9"));
  EXPECT_EQ(refusal(), "run.json: scenario: objects: event: a breakup has 1 to 100000 fragments");
}

TEST_F(RunRecords, DebrisOfAPopulationAreObjectsWithElements) {
  const auto record = [](const std::string& min_size_m) {
    std::string inclinations = "4";
    for (int degree = 1; degree < 180; ++degree) inclinations += degree == 98 ? ",6" : ",0";
    return R"({"status":"complete","seed":7,"scenario":{"sensors":[],"objects":[
{"population":"p","first_number":990000001,"debris":[2020,130,0.01,)" +
           min_size_m + R"(,0.1,700000,900000,2458138.5,0.75],"inclinations":[)" + inclinations +
           R"(],"radius_m":1,"albedo":0.175,"only":[]}]}})";
  };
  write(record("0.05"));
  const RunRecord run = *read_run_record(directory);
  EXPECT_TRUE(run.catalogues.empty());
  ASSERT_GT(run.own_objects.size(), 10u);
  EXPECT_EQ(run.own_objects[5].catalogue_number, 990000006u);
  EXPECT_EQ(run.own_objects[5].elements->name.substr(0, 2), "p-");
  EXPECT_EQ(run.own_objects[5].elements->epoch_jd2, 0.75);
  write(record("1e-9"));
  EXPECT_EQ(refusal(),
            "run.json: scenario: objects: debris: a population has up to 1000000 objects within a "
            "shell");
}

TEST_F(RunRecords, RefusesANameThatLeavesTheDirectory) {
  write(R"({"status":"complete","scenario":{"sensors":[{"name":"../../etc"}]}})");
  EXPECT_EQ(refusal(),
            "run.json: scenario: sensors: name: can't be the name of a directory: ../../etc");
}

TEST_F(RunRecords, PlannedLevelsAreBySensorAndFrame) {
  const std::string path = path_in(directory, run_file::record);
  write(R"({"status":"complete","frames":[{"sensor":"eye","frame":2,
"plan":{"effects":{"airglow":{"level":"full"}}}},{"sensor":"eye","frame":3}]})");
  const auto levels = read_planned_levels(path);
  EXPECT_EQ(levels.at("eye").size(), 1u);
  EXPECT_EQ(levels.at("eye").at(2).at("airglow"), "full");
  write("{}");
  EXPECT_THROW(read_planned_levels(path), ConfigError);
}

}  // namespace
}  // namespace dmise
