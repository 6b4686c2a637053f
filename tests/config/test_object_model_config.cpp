#include "core/config/object_model_config.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/json.h"
#include "core/base/paths.h"
#include "core/base/whole_file.h"
#include "core/config/object_config.h"
#include "core/config/yaml_reader.h"

namespace dmise {
namespace {

ObjectsConfig read(const std::string& objects) {
  setenv("DMISE_HOME", DMISE_SOURCE_DIR, 1);
  return read_objects(
      YamlMap(YamlValue::parse("objects:\n" + objects + "\n", "s.yaml")).require("objects"),
      Utc{2458139.5, 0.0});
}

ObjectModels models(const std::string& text) {
  return read("- {catalogue: demo, models: " + text + "}").catalogues.at(0).models;
}

std::string complaint(const std::string& objects) {
  try {
    read(objects);
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "";
}

std::string json(const std::string& objects) {
  JsonWriter writer;
  const auto read_ones = read(objects);
  writer.begin_object();
  write_objects(writer, read_ones.catalogues, read_ones.own);
  return writer.end_object().take();
}

std::string name_of(const ObjectModels& models, const std::string& name, std::uint32_t number = 1) {
  const ObjectModel* model = models.of(name, number);
  return model ? model->name : "";
}

TEST(ObjectModels, AreOfNamesAndNumbers) {
  const auto some = models("{\"STARLINK*\": starlink-v1.5, \"4460[0-9]\": oneweb}");
  EXPECT_EQ(name_of(some, "STARLINK-1007"), "starlink-v1.5");
  EXPECT_EQ(name_of(some, "starlink-1007"), "");
  EXPECT_EQ(name_of(some, "X", 44607), "oneweb");
  EXPECT_EQ(name_of(some, "STARLINK-1007", 44607), "starlink-v1.5");  // the first that fits
  EXPECT_EQ(name_of(some, "X", 446071), "");
  EXPECT_EQ(name_of({}, "STARLINK-1007"), "");
}

// Iridium NEXT begins at 100; those of 1997 to 2002 end at 98.
TEST(ObjectModels, ShippedOnesKnowTheirNames) {
  const auto shipped = models("shipped");
  EXPECT_EQ(name_of(shipped, "STARLINK-1007"), "starlink-v1.5");
  EXPECT_EQ(name_of(shipped, "ONEWEB-0012"), "oneweb");
  EXPECT_EQ(name_of(shipped, "IRIDIUM 106"), "iridium-next");
  EXPECT_EQ(name_of(shipped, "IRIDIUM 106 [+]"), "iridium-next");
  EXPECT_EQ(name_of(shipped, "IRIDIUM 98"), "");
  EXPECT_EQ(name_of(shipped, "IRIDIUM 10 [-]"), "");
  EXPECT_EQ(name_of(shipped, "ISS (ZARYA)"), "");
  for (const auto& rule : shipped.rules()) {
    EXPECT_FALSE(rule.model->source.empty()) << rule.model->name;
    EXPECT_FALSE(rule.model->geometry.mesh->triangles.empty()) << rule.model->name;
  }
}

TEST(ObjectModels, GiveAnObjectItsLooks) {
  const std::string fixed = "motion: {fixed: {gcrs_m: [1e7, 0, 0]}}";
  const auto object = read("- {name: x, " + fixed + ", model: oneweb}").own.at(0);
  ASSERT_TRUE(object.geometry && object.panel && object.attitude);
  EXPECT_TRUE(std::holds_alternative<NadirAttitude>(object.attitude->model));
  const auto turned =
      read("- {name: x, " + fixed + ", model: oneweb, attitude: sun_tracking}").own.at(0);
  EXPECT_TRUE(std::holds_alternative<SunYawAttitude>(turned.attitude->model));
  EXPECT_EQ(complaint("- {name: x, " + fixed + ", model: oneweb, geometry: {model: box}}"),
            "s.yaml:2:78: objects[0].geometry: the model has it");
}

TEST(ObjectModels, SayWhereAndWhy) {
  EXPECT_EQ(complaint("- {catalogue: demo, models: shiped}"),
            "s.yaml:2:29: objects[0].models: must be shipped, or a mapping of patterns to models, "
            "got shiped");
  const std::string unknown = complaint("- {catalogue: demo, models: {A: onweb}}");
  EXPECT_EQ(unknown.rfind("s.yaml:2:33: objects[0].models.A: no such model, did you mean oneweb? "
                          "(a path to a YAML file, or one of ",
                          0),
            0u)
      << unknown;
  EXPECT_EQ(complaint("- {catalogue: demo, models: shipped}\n- {catalogue: demo, models: shipped}"),
            "s.yaml:3:29: objects[1].models: another catalogue states models, which are of all");
  const std::string path = testing::TempDir() + "told.yaml";
  write_file_whole(path, "source: nobody\nattitude: {node: gnc}\ngeometry: {model: sphere}\n");
  EXPECT_EQ(complaint("- {catalogue: demo, models: {A: " + path + "}}"),
            path + ":2:11: attitude: must be nadir, sun_tracking, inertial or spinning");
  remove_file(path);
}

// A catalogue without models has the digest that it had before there were any.
TEST(ObjectModels, ShowInThePhysicsDigest) {
  const std::string none = json("- {catalogue: demo}");
  EXPECT_EQ(none.find("models"), std::string::npos);
  EXPECT_NE(none, json("- {catalogue: demo, models: {A: oneweb}}"));
  EXPECT_NE(json("- {catalogue: demo, models: {B: oneweb}}"),
            json("- {catalogue: demo, models: {A: oneweb}}"));
  EXPECT_NE(json("- {catalogue: demo, models: {A: iridium-next}}"),
            json("- {catalogue: demo, models: {A: oneweb}}"));
}

}  // namespace
}  // namespace dmise
