#include "core/config/objects/object_model_config.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/files/json.h"
#include "core/base/files/paths.h"
#include "core/base/files/whole_file.h"
#include "core/config/objects/object_config.h"
#include "core/config/yaml/yaml_reader.h"

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
  EXPECT_EQ(name_of(shipped, "SL-16 R/B"), "sl-16-rocket-body");
  EXPECT_EQ(name_of(shipped, "SL-8 R/B"), "sl-8-rocket-body");
  EXPECT_EQ(name_of(shipped, "SL-14 R/B"), "");
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
            path + ":2:11: attitude: must be nadir, sun_tracking, inertial, spinning or tumbling");
  remove_file(path);
}

TEST(ObjectModels, MayHaveSmallPartsThatGlint) {
  const auto shipped = models("shipped");
  const ObjectModel* oneweb = shipped.of("ONEWEB-0012", 1);
  ASSERT_TRUE(oneweb && oneweb->glints);
  EXPECT_GT(oneweb->glints->widest_rad, oneweb->glints->narrowest_rad);
  EXPECT_TRUE(oneweb->glints->edges);
  EXPECT_FALSE(shipped.of("STARLINK-1007", 1)->glints);
  const std::string fixed = "motion: {fixed: {gcrs_m: [1e7, 0, 0]}}";
  EXPECT_TRUE(read("- {name: x, " + fixed + ", model: oneweb}").own.at(0).glints);
  EXPECT_FALSE(read("- {name: x, " + fixed + ", model: starlink-v1.5}").own.at(0).glints);
}

TEST(ObjectModels, SayWhatIsWrongWithGlints) {
  const std::string path = testing::TempDir() + "glints.yaml";
  const auto complaint_of = [&](const std::string& glints) {
    write_file_whole(
        path, "source: me\nattitude: nadir\ngeometry: {model: sphere}\nglints: " + glints + "\n");
    const std::string text = complaint("- {catalogue: demo, models: {A: " + path + "}}");
    return text.rfind(path, 0) == 0 ? text.substr(path.size()) : text;
  };
  EXPECT_EQ(complaint_of("{lobe_deg: [1, 4], parts_in_view: 0.1, share: [0.1, 0.2]}"), "");
  EXPECT_EQ(complaint_of("{lobe_deg: [4, 1], parts_in_view: 0.1, share: [0.1, 0.2]}"),
            ":4:20: glints.lobe_deg: the narrowest must not be wider than the widest");
  EXPECT_EQ(complaint_of("{lobe_deg: [1, 4], parts_in_view: 0.1, share: [0.5, 0.5]}"),
            ":4:55: glints.share: the lobes of all widths have 1.5 of the light; at most 1");
  EXPECT_EQ(complaint_of("{lobe_deg: [1, 4], parts_in_view: 0, share: [0.1, 0.2]}"),
            ":4:43: glints.parts_in_view: must be >= 0.001, got 0");
  const auto with_edges = [&](const std::string& edges) {
    return complaint_of(
        "{lobe_deg: [1, 4], parts_in_view: 0.1, share: [0.1, 0.2], edges: " + edges + "}");
  };
  EXPECT_EQ(with_edges("{half_width_deg: 2, share: 0.01}"), "");
  EXPECT_EQ(with_edges("{axis: [0, 0, 0], half_width_deg: 2, share: 0.01}"),
            ":4:81: glints.edges.axis: must not be zero");
  EXPECT_EQ(
      with_edges("{half_width_deg: 2, share: 0.8}"),
      ":4:55: glints.share: the lobes of all widths and edges have 1.24 of the light; at most "
      "1");
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
