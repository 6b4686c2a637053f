#include "core/config/objects/breakup_config.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/files/json.h"
#include "core/config/yaml/yaml_reader.h"

namespace dmise {
namespace {

ObjectsConfig read_broken(const std::string& text) {
  return read_objects(YamlMap(YamlValue::parse("objects:\n" + text, "s.yaml")).require("objects"),
                      {2458139.5, 0.0});
}

std::string complaint_of_broken(const std::string& text) {
  try {
    read_broken(text);
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "";
}

const std::string orbit =
    "parent: {two_body: {semi_major_axis_m: 7178137, eccentricity: 0, inclination_deg: 98.6}}";
const std::string blast = orbit + ", kind: explosion, mass_kg: 900";
const std::string crash =
    orbit +
    ", kind: collision, mass_kg: 900, projectile_mass_kg: 556, relative_speed_m_per_s: 11700";

ObjectSource source_of(const std::string& keys, const std::string& beside = "") {
  return read_broken("- {breakup: {" + keys + "}" + beside + "}").catalogues.at(0);
}

TEST(BreakupConfig, KeysAndDefaults) {
  const ObjectSource plain = source_of(blast);
  const Breakup& b = plain.breakup.value();
  EXPECT_EQ(plain.named, "breakup");
  EXPECT_EQ(plain.sphere.albedo, 0.175);
  EXPECT_EQ(b.event, (BreakupEvent{.mass_kg = 900, .min_length_m = 0.1}));
  EXPECT_EQ(b.epoch, (Utc{2458139.5, 0.0}));
  EXPECT_FALSE(b.seed);
  EXPECT_NEAR(norm(b.parent.position_m), 7178137, 1e-3);
  EXPECT_EQ(b.fragment_count(), 238);
  const ObjectSource other =
      source_of(crash +
                    ", structure: upper_stage, least_length_m: 0.05, seed: 9, "
                    "at: 2018-01-20T12:00:00Z",
                ", name: iridium, albedo: 0.3");
  EXPECT_EQ(other.breakup->event, (BreakupEvent{.kind = BreakupKind::collision,
                                                .structure = BrokenStructure::upper_stage,
                                                .mass_kg = 900,
                                                .projectile_mass_kg = 556,
                                                .relative_speed_m_per_s = 11700,
                                                .min_length_m = 0.05}));
  EXPECT_EQ(other.breakup->seed, 9u);
  EXPECT_EQ(other.breakup->name, "iridium");
  EXPECT_EQ(other.breakup->epoch, (Utc{2458138.5, 0.5}));
  EXPECT_EQ(other.sphere.albedo, 0.3);
}

TEST(BreakupConfig, AParentIsAnyObjectWhereverItIsListed) {
  const std::string named = "kind: explosion, mass_kg: 900, parent: ";
  const auto objects = read_broken(
      "- {breakup: {" + named + "w-1-1}}\n" + "- {breakup: {" + named + "stage}, name: b}\n" +
      "- {walker: {total: 2, planes: 1, height_m: 550.0e+3, inclination_deg: 53}, name: w}\n"
      "- {name: stage, motion: {two_body: {semi_major_axis_m: 7178137, eccentricity: 0, "
      "inclination_deg: 98.6}}}\n");
  EXPECT_NEAR(norm(objects.catalogues[0].breakup->parent.position_m), 6378137 + 550e3, 2e4);
  EXPECT_NEAR(norm(objects.catalogues[1].breakup->parent.position_m), 7178137, 1e-3);
  // Own objects, then what is made, in the scenario's order.
  EXPECT_EQ(objects.own[0].catalogue_number, first_own_number);
  EXPECT_EQ(objects.catalogues[0].breakup->first_number, first_own_number + 1);
  EXPECT_EQ(objects.catalogues[1].breakup->first_number, first_own_number + 239);
  EXPECT_EQ(objects.catalogues[2].walker->first_number, first_own_number + 477);
  EXPECT_EQ(complaint_of_broken("- {breakup: {" + named + "nobody}}"),
            "s.yaml:2:53: objects[0].breakup.parent: no object has this name or number, got "
            "nobody");
}

TEST(BreakupConfig, SaysWhereAndWhy) {
  const auto of = [](const std::string& keys) {
    return complaint_of_broken("- {breakup: {" + keys + "}}");
  };
  const std::string start = "s.yaml:2:";
  const auto at = [&](const std::string& keys, const std::string& key) {
    return start + std::to_string(14 + keys.find(key + ":") + key.size() + 2) +
           ": objects[0].breakup." + key + ": ";
  };
  const auto expect = [&](const std::string& keys, const std::string& key,
                          const std::string& reason) {
    EXPECT_EQ(of(keys), at(keys, key) + reason);
  };
  expect(blast + ", at: 2018-01-21T00:00:01Z", "at",
         "must be at or before the start of the run: no object begins within a run, got "
         "2018-01-21T00:00:01Z");
  expect(blast + ", projectile_mass_kg: 1", "projectile_mass_kg", "goes with kind: collision");
  expect(crash + ", scale: 1", "scale", "goes with kind: explosion");
  expect(blast + ", scale: 1000, least_length_m: 0.001", "least_length_m",
         "makes 3.786e+08 fragments, at most 100000 are possible, got 0.001");
  expect(blast + ", scale: 0.01, least_length_m: 1", "least_length_m", "makes no fragment, got 1");
  expect(blast + ", least_length_m: 2", "least_length_m", "must be <= 1, got 2");
  EXPECT_EQ(of(orbit + ", kind: collision, mass_kg: 900"),
            "s.yaml:2:13: objects[0].breakup.projectile_mass_kg: is missing");
  EXPECT_EQ(of("kind: explosion, mass_kg: 1"),
            "s.yaml:2:13: objects[0].breakup.parent: is missing");
  EXPECT_EQ(of(blast + ", size: 1"), "s.yaml:2:" + std::to_string(14 + blast.size() + 2) +
                                         ": objects[0].breakup.size: unknown key");
  const std::string one = "- {breakup: {" + blast + "}}\n";
  EXPECT_EQ(
      complaint_of_broken(one + one),
      "s.yaml:3:3: objects[1]: another constellation, breakup or population has the name breakup");
}

TEST(BreakupConfig, EveryChangeShowsInThePhysicsDigest) {
  const auto json = [](const std::string& text) {
    JsonWriter writer;
    const auto objects = read_broken(text);
    writer.begin_object();
    write_objects(writer, objects.catalogues, objects.own);
    return writer.end_object().take();
  };
  const std::string good = "- {breakup: {" + crash +
                           ", structure: spacecraft, at: 2018-01-20T12:00:00Z, least_length_m: "
                           "0.1, seed: 4}, name: w, albedo: 0.2}";
  for (const auto& [what, with] : {std::pair{"98.6", "98.7"},
                                   {"mass_kg: 900", "mass_kg: 901"},
                                   {"556", "557"},
                                   {"11700", "11701"},
                                   {"spacecraft", "upper_stage"},
                                   {"T12:00:00", "T12:00:01"},
                                   {"0.1,", "0.11,"},
                                   {"seed: 4", "seed: 5"},
                                   {"name: w", "name: v"},
                                   {"albedo: 0.2", "albedo: 0.3"}}) {
    std::string other = good;
    other.replace(other.find(what), std::string(what).size(), with);
    EXPECT_NE(json(good), json(other)) << with;
  }
  const std::string burst = "- {breakup: {" + blast + ", scale: 1}}";
  std::string more = burst;
  more.replace(more.find("scale: 1"), 8, "scale: 2");
  EXPECT_NE(json(burst), json(more));
}

}  // namespace
}  // namespace dmise
