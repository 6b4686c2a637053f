#include "core/config/objects/generators/population_config.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/files/json.h"
#include "core/base/units.h"
#include "core/config/objects/object_config.h"
#include "core/config/yaml/yaml_reader.h"

namespace dmise {
namespace {

ObjectsConfig read_debris(const std::string& text, const Utc& start = {2458139.5, 0.0}) {
  return read_objects(YamlMap(YamlValue::parse("objects:\n" + text, "s.yaml")).require("objects"),
                      start);
}

std::string complaint_of_debris(const std::string& keys, const Utc& start = {2458139.5, 0.0}) {
  try {
    read_debris("- {population: {" + keys + "}}", start);
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "";
}

TEST(PopulationConfig, KeysAndDefaults) {
  const ObjectSource plain = read_debris("- {population: {min_size_m: 0.05}}").catalogues.at(0);
  const DebrisPopulation& p = plain.population.value();
  EXPECT_EQ(p.name, "population");
  EXPECT_NEAR(p.year, 2018 + 20.5 / 365.25, 2e-3);
  EXPECT_EQ(p.max_size_m, 0.1);
  EXPECT_EQ(p.max_height_m, 2000e3);
  EXPECT_EQ(p.solar_flux_sfu, 130.0);
  EXPECT_FALSE(p.seed);
  EXPECT_NEAR(plain.sphere.albedo, 0.175, 1e-12);
  const ObjectSource other =
      read_debris(
          "- {population: {min_size_m: 0.02, max_size_m: 0.05, min_height_m: 500.0e+3, "
          "max_height_m: 600.0e+3, inclinations: demo, year: 2001.5, solar_flux_sfu: 200, scale: "
          "0.5, seed: 9}, name: bits, albedo: 0.1}")
          .catalogues.at(0);
  EXPECT_EQ(other.population->year, 2001.5);
  EXPECT_EQ(other.population->scale, 0.5);
  EXPECT_EQ(other.population->seed, 9u);
  EXPECT_EQ(other.population->name, "bits");
  EXPECT_EQ(other.sphere.albedo, 0.1);
}

TEST(PopulationConfig, NumbersFollowThoseOfOwnObjects) {
  const auto objects = read_debris(
      "- {population: {min_size_m: 0.09}}\n"
      "- {walker: {total: 2, planes: 1, height_m: 550.0e+3, inclination_deg: 53}, name: w}\n"
      "- {name: a, motion: {fixed: {gcrs_m: [1e7, 0, 0]}}}\n");
  const DebrisPopulation& p = *objects.catalogues[0].population;
  EXPECT_EQ(p.first_number, first_own_number + 1);
  EXPECT_GT(p.numbers(), p.mean_count());
  EXPECT_EQ(objects.catalogues[1].walker->first_number,
            p.first_number + std::uint32_t(p.numbers()));
}

// SSP 30425 has 0.990 for spacecraft at 45 deg and 1.030 at 52 deg, by the catalogue of the 1980s.
TEST(PopulationConfig, InclinationsGiveThePublishedFactor) {
  const DebrisPopulation p =
      *read_debris("- {population: {min_size_m: 0.05}}").catalogues[0].population;
  EXPECT_NEAR(
      encounter_factor(p.inclinations, 52 * deg) / encounter_factor(p.inclinations, 45 * deg),
      1.030 / 0.990, 0.02);
}

TEST(PopulationConfig, SaysWhereAndWhy) {
  const auto of = [](const std::string& keys) { return complaint_of_debris(keys); };
  EXPECT_EQ(of("max_size_m: 0.1"), "s.yaml:2:16: objects[0].population.min_size_m: is missing");
  EXPECT_EQ(
      of("min_size_m: 0.1"),
      "s.yaml:2:29: objects[0].population.min_size_m: must be below max_size_m, 0.1, got 0.1");
  EXPECT_EQ(
      of("min_size_m: 0.001"),
      "s.yaml:2:29: objects[0].population.min_size_m: makes 1.549e+08 objects, at most 1000000 "
      "are possible, got 0.001");
  EXPECT_EQ(of("min_size_m: 0.05, max_height_m: 100"),
            "s.yaml:2:49: objects[0].population.max_height_m: must be >= 2e+05, got 100");
  EXPECT_EQ(of("min_size_m: 0.05, max_height_m: 200.0e+3"),
            "s.yaml:2:16: objects[0].population: min_height_m must be below max_height_m");
  EXPECT_EQ(of("min_size_m: 0.05, inclinations: nowhere.tle"),
            "s.yaml:2:49: objects[0].population.inclinations: there is no such file, got "
            "nowhere.tle");
  EXPECT_EQ(of("min_size_m: 0.05, min_height_m: 1990.0e+3"),
            "s.yaml:2:16: objects[0].population: no object of demo is at these heights");
  EXPECT_EQ(complaint_of_debris("min_size_m: 0.05", {2440587.5, 0.0}),
            "s.yaml:2:16: objects[0].population: needs a year from 1988 to 2100: the run starts in "
            "another");
}

TEST(PopulationConfig, EveryChangeShowsInThePhysicsDigest) {
  const auto json = [](const std::string& text, const Utc& start = {2458139.5, 0.0}) {
    JsonWriter writer;
    const auto objects = read_debris(text, start);
    writer.begin_object();
    write_objects(writer, objects.catalogues, objects.own);
    return writer.end_object().take();
  };
  const std::string good =
      "- {population: {min_size_m: 0.05, max_size_m: 0.5, min_height_m: 500.0e+3, max_height_m: "
      "900.0e+3, inclinations: demo, year: 2020, solar_flux_sfu: 150, scale: 2, seed: 4}, name: w, "
      "albedo: 0.2}";
  for (const auto& [what, with] : {std::pair{"0.05", "0.06"},
                                   {"0.5,", "0.6,"},
                                   {"500.0", "510.0"},
                                   {"900.0", "910.0"},
                                   {"2020", "2021"},
                                   {"150", "151"},
                                   {"scale: 2", "scale: 3"},
                                   {"seed: 4", "seed: 5"},
                                   {"name: w", "name: v"},
                                   {"albedo: 0.2", "albedo: 0.3"}}) {
    std::string other = good;
    other.replace(other.find(what), std::string(what).size(), with);
    EXPECT_NE(json(good), json(other)) << with;
  }
  EXPECT_NE(json(good), json(good, {2458140.5, 0.0}));
}

}  // namespace
}  // namespace dmise
