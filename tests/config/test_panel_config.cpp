#include "core/config/objects/panel_config.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/files/json.h"
#include "core/base/files/whole_file.h"
#include "core/config/objects/object_config.h"
#include "core/config/yaml/yaml_reader.h"

namespace dmise {
namespace {

ObjectsConfig read(const std::string& keys) {
  setenv("DMISE_HOME", DMISE_SOURCE_DIR, 1);
  const std::string text =
      "objects:\n- {name: x, motion: {fixed: {gcrs_m: [1e7, 0, 0]}}, attitude: nadir, " + keys +
      "}\n";
  return read_objects(YamlMap(YamlValue::parse(text, "s.yaml")).require("objects"),
                      Utc{2458139.5, 0.0});
}

HingedPanel panel(const std::string& keys) { return read(keys).own.at(0).panel.value(); }

std::string complaint(const std::string& keys) {
  try {
    read(keys);
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "";
}

std::string json(const std::string& keys) {
  JsonWriter writer;
  const auto objects = read(keys);
  writer.begin_object();
  write_objects(writer, objects.catalogues, objects.own);
  return writer.end_object().take();
}

std::string obj_file(const std::string& name, const std::string& text) {
  const std::string path = testing::TempDir() + "/" + name;
  write_file_whole(path, "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nusemtl grey\n" + text);
  return path;
}

TEST(PanelConfig, TurnsAsItsModelDoesUnlessToldOtherwise) {
  EXPECT_EQ(panel("panel: {}"), HingedPanel{});
  EXPECT_EQ(panel("panel: {}, geometry: {model: box-wing}"), HingedPanel{});
  const HingedPanel array = panel("geometry: {model: starlink-like, scale: 2}, panel: {}");
  EXPECT_EQ(array.axes, (SunTrackingPanel{.hinge = {1, 0, 0}, .normal = {0, 1, 0}}));
  EXPECT_NEAR(array.hinge_m.z, -0.4, 1e-15);
  const HingedPanel turned = panel("geometry: {model: starlink-like, yaw_deg: -90}, panel: {}");
  EXPECT_NEAR(turned.axes.normal.x, 1.0, 1e-15);
  EXPECT_NEAR(turned.axes.hinge.y, -1.0, 1e-15);
  EXPECT_EQ(panel("geometry: {model: starlink-like, scale: 2}, "
                  "panel: {hinge: [0, 0, 2], hinge_m: [1, 2, 3]}"),
            (HingedPanel{{.hinge = {0, 0, 1}, .normal = {0, 1, 0}}, {1, 2, 3}}));
}

TEST(PanelConfig, OfAnObjIsWhatItsNamesSay) {
  const std::string wing = obj_file("wing.obj", "o bus\nf 1 2 3\no Panel-1\nf 1 3 4\n");
  const auto object = read("geometry: {obj: " + wing + "}, panel: {}").own.at(0);
  EXPECT_TRUE(has_panel(*object.geometry->mesh));
  EXPECT_EQ(*object.panel, HingedPanel{});
  EXPECT_FALSE(has_panel(*read("geometry: {obj: " + wing + "}").own.at(0).geometry->mesh));
}

TEST(PanelConfig, SaysWhereAndWhy) {
  const std::string none =
      "the geometry has no panel: a box-wing, a starlink-like and an OBJ with objects or groups "
      "named panel have one";
  EXPECT_EQ(complaint("panel: {}, geometry: {model: sphere}"),
            "s.yaml:2:77: objects[0].panel: " + none);
  const std::string bus = obj_file("bus.obj", "o bus\nf 1 2 3\n");
  EXPECT_EQ(complaint("panel: {}, geometry: {obj: " + bus + "}"),
            "s.yaml:2:77: objects[0].panel: " + none);
  EXPECT_EQ(complaint("panel: {hinge_m: [0, 0, 1]}"),
            "s.yaml:2:87: objects[0].panel.hinge_m: needs a geometry");
  EXPECT_EQ(complaint("panel: {hinge: [0, 0, 1]}, geometry: {model: box-wing}"),
            "s.yaml:2:77: objects[0].panel: hinge and normal must not be parallel");
  EXPECT_EQ(complaint("panel: {hinge: [0, 1, 0], normal: [0, 0, 1]}, "
                      "geometry: {model: starlink-like}"),
            "s.yaml:2:104: objects[0].panel.normal: no facet of the panel faces its normal to 45 "
            "deg");
  EXPECT_EQ(complaint("panel: {hinge_m: [0, 0, 2e5]}, geometry: {model: box-wing}"),
            "s.yaml:2:94: objects[0].panel.hinge_m[2]: must be <= 1e+05, got 2e5");
}

// What turns, and about what, is in the run's digest; a panel that does not turn is not.
TEST(PanelConfig, ShowsInThePhysicsDigest) {
  const std::string wings = "geometry: {model: box-wing}, panel: {hinge_m: [0, 0, 0]}";
  EXPECT_EQ(json(wings), json("geometry: {model: box-wing}, panel: {}"));
  EXPECT_NE(json(wings), json("geometry: {model: box-wing}, panel: {hinge_m: [0, 0, 1]}"));
  EXPECT_NE(json(wings), json("geometry: {model: box-wing}"));
  EXPECT_EQ(json("panel: {}").find("panel_hinge_m"), std::string::npos);
  const std::string one = obj_file("one.obj", "o panel\nf 1 2 3\no bus\nf 1 3 4\n");
  const std::string other = obj_file("other.obj", "o bus\nf 1 2 3\no panel\nf 1 3 4\n");
  EXPECT_EQ(json("geometry: {obj: " + one + "}"), json("geometry: {obj: " + other + "}"));
  EXPECT_NE(json("geometry: {obj: " + one + "}, panel: {}"),
            json("geometry: {obj: " + other + "}, panel: {}"));
}

}  // namespace
}  // namespace dmise
