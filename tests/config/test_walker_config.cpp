#include "core/config/objects/generators/walker_config.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/files/json.h"
#include "core/base/units.h"
#include "core/config/objects/object_config.h"
#include "core/config/yaml/yaml_reader.h"

namespace dmise {
namespace {

ObjectsConfig read(const std::string& text) {
  return read_objects(YamlMap(YamlValue::parse("objects:\n" + text, "s.yaml")).require("objects"),
                      {2458139.5, 0.0});
}

const std::string keys = "planes: 3, height_m: 550.0e+3, inclination_deg: 53";

ObjectSource source(const std::string& more, const std::string& beside = "") {
  return read("- {walker: {" + keys + ", " + more + "}" + beside + "}").catalogues.at(0);
}

std::string complaint(const std::string& text) {
  try {
    read(text);
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "";
}

TEST(WalkerConfig, KeysAndDefaults) {
  const Walker plain = source("total: 24").walker.value();
  EXPECT_EQ(plain.name, "walker");
  EXPECT_EQ(plain.per_plane, 8);
  EXPECT_EQ(plain.satellites(), 24);
  EXPECT_EQ(plain.phasing, 0);
  EXPECT_EQ(plain.semi_major_axis_m, 6378137.0 + 550e3);
  EXPECT_EQ(plain.raan_spread_rad, 2 * pi);
  EXPECT_EQ(plain.epoch, (Utc{2458139.5, 0.0}));
  const ObjectSource star = source(
      "per_plane: 5, phasing: 2, raan_spread_deg: 180, raan_deg: 10, "
      "argument_of_latitude_deg: 20, epoch: 2018-01-21T06:00:00Z",
      ", name: ring, radius_m: 2, albedo: 0.3");
  EXPECT_EQ(star.walker->satellites(), 15);
  EXPECT_EQ(star.walker->phasing, 2);
  EXPECT_NEAR(star.walker->raan_spread_rad, pi, 1e-12);
  EXPECT_NEAR(star.walker->raan_rad, 10 * deg, 1e-12);
  EXPECT_NEAR(star.walker->argument_of_latitude_rad, 20 * deg, 1e-12);
  EXPECT_EQ(star.walker->epoch.jd2, 0.25);
  EXPECT_EQ(star.walker->name, "ring");
  EXPECT_EQ(star.sphere.radius_m, 2.0);
}

// Own objects keep their numbers, whatever constellations there are.
TEST(WalkerConfig, NumbersFollowThoseOfOwnObjects) {
  const std::string fixed = ", motion: {fixed: {gcrs_m: [1e7, 0, 0]}}}\n";
  const auto walker = [](const std::string& name) {
    return "- {walker: {" + keys + ", total: 6}, name: " + name + "}\n";
  };
  const auto objects =
      read(walker("p") + "- {name: a" + fixed + walker("q") + "- {name: b" + fixed);
  EXPECT_EQ(objects.own[0].catalogue_number, first_own_number);
  EXPECT_EQ(objects.own[1].catalogue_number, first_own_number + 1);
  EXPECT_EQ(objects.catalogues[0].walker->first_number, first_own_number + 2);
  EXPECT_EQ(objects.catalogues[1].walker->first_number, first_own_number + 8);
  const auto beyond = read(walker("p") + "- {name: a, catalogue_number: 990000003" + fixed);
  EXPECT_EQ(beyond.catalogues[0].walker->first_number, 990000004u);
  EXPECT_EQ(complaint(walker("p") + "- {name: a, catalogue_number: 999999999" + fixed),
            "s.yaml:2:12: objects[0].walker: no catalogue numbers are left for its satellites");
}

TEST(WalkerConfig, ATrainIsOfOnePlane) {
  const ObjectSource source =
      read(
          "- {train: {count: 60, spacing_s: 12, height_m: 290.0e+3, inclination_deg: 53, "
          "raan_deg: 10}}")
          .catalogues.at(0);
  EXPECT_EQ(source.named, "train");
  EXPECT_EQ(source.walker->planes, 1);
  EXPECT_EQ(source.walker->per_plane, 60);
  EXPECT_EQ(source.walker->spacing_s, 12.0);
  EXPECT_NEAR(source.walker->raan_rad, 10 * deg, 1e-12);
}

TEST(WalkerConfig, SaysWhereAndWhy) {
  const auto of = [](const std::string& text) { return complaint("- {walker: {" + text + "}}"); };
  EXPECT_EQ(of(keys), "s.yaml:2:12: objects[0].walker: needs either total or per_plane");
  EXPECT_EQ(of(keys + ", total: 6, per_plane: 2"),
            "s.yaml:2:12: objects[0].walker: needs either total or per_plane");
  EXPECT_EQ(of(keys + ", total: 7"),
            "s.yaml:2:72: objects[0].walker.total: must be a multiple of planes, got 7");
  EXPECT_EQ(of(keys + ", total: 6, phasing: 3"),
            "s.yaml:2:84: objects[0].walker.phasing: must be below the number of planes, got 3");
  EXPECT_EQ(of(keys + ", per_plane: 50000"),
            "s.yaml:2:12: objects[0].walker: must have at most 100000 satellites");
  EXPECT_EQ(of("planes: 1, total: 1, inclination_deg: 0"),
            "s.yaml:2:12: objects[0].walker: needs either height_m or semi_major_axis_m (from the "
            "Earth's centre)");
  EXPECT_EQ(of("planes: 1, total: 1, inclination_deg: 0, height_m: 550"),
            "s.yaml:2:64: objects[0].walker.height_m: must be >= 121863, got 550");
  EXPECT_EQ(complaint("- {train: {count: 2, height_m: 550.0e+3, inclination_deg: 53}}"),
            "s.yaml:2:11: objects[0].train.spacing_s: is missing");
  EXPECT_EQ(complaint("- {train: {}, walker: {}}"),
            "s.yaml:2:11: objects[0].train: goes without walker");
  const std::string one = "- {walker: {" + keys + ", total: 6}}\n";
  EXPECT_EQ(
      complaint(one + one),
      "s.yaml:3:3: objects[1]: another constellation, breakup or population has the name walker");
  const std::string name(49, 'n');
  EXPECT_EQ(complaint("- {walker: {" + keys + ", total: 6}, name: " + name + "}"),
            "s.yaml:2:82: objects[0].name: must have 1 to 48 characters, got " + name);
  EXPECT_EQ(complaint("- {walker: {" + keys + ", total: 6}, only: [a]}"),
            "s.yaml:2:76: objects[0].only: unknown key");
}

TEST(WalkerConfig, EveryChangeShowsInThePhysicsDigest) {
  const auto json = [](const std::string& text) {
    JsonWriter writer;
    const auto objects = read(text);
    writer.begin_object();
    write_objects(writer, objects.catalogues, objects.own);
    return writer.end_object().take();
  };
  const std::string good =
      "- {walker: {total: 24, planes: 3, phasing: 1, height_m: 550.0e+3, inclination_deg: 53, "
      "raan_spread_deg: 360, raan_deg: 0, argument_of_latitude_deg: 4, epoch: "
      "2018-01-21T00:00:00Z}, name: w}";
  for (const auto& [what, with] : {std::pair{"total: 24", "total: 27"},
                                   {"planes: 3", "planes: 4"},
                                   {"phasing: 1", "phasing: 2"},
                                   {"550", "551"},
                                   {"53", "54"},
                                   {"360", "180"},
                                   {"raan_deg: 0", "raan_deg: 1"},
                                   {"latitude_deg: 4", "latitude_deg: 5"},
                                   {"T00:00:00", "T00:00:01"},
                                   {"name: w", "name: v"}}) {
    std::string other = good;
    other.replace(other.find(what), std::string(what).size(), with);
    EXPECT_NE(json(good), json(other)) << with;
  }
}

}  // namespace
}  // namespace dmise
