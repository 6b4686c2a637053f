#include "core/config/objects/geometry_config.h"

#include <cmath>
#include <filesystem>

#include "core/base/error.h"
#include "core/base/files/digest.h"
#include "core/base/files/json.h"
#include "core/base/units.h"
#include "core/config/objects/material_config.h"
#include "core/config/yaml/bound_key.h"
#include "core/config/yaml/search_path.h"
#include "core/config/yaml/yaml_reader.h"
#include "core/materials/obj_file.h"
#include "core/materials/shapes.h"

namespace dmise {
namespace {

constexpr double largest_m = 1e5;

Forms size() { return form::above(0.0, largest_m); }
Forms sizes(std::size_t count) { return form::positive_numbers(count, largest_m); }

std::vector<double> sizes(YamlMap& map, std::string_view key, std::size_t count,
                          std::vector<double> otherwise) {
  const auto value = map.find(key);
  if (!value) return otherwise;
  std::vector<double> all;
  for (const auto& item : value->list()) all.push_back(item.number());
  if (all.size() != count)
    value->fail(
        "must have " + std::to_string(count) + " lengths, got " + std::to_string(all.size()),
        false);
  return all;
}

/// The surfaces that are fitted to the brightness of whole satellites.
const MaterialLibrary& effective_surfaces() {
  static const std::string path = find_preset("materials", "effective", "");
  static const MaterialLibrary library = path.empty() ? MaterialLibrary() : MaterialLibrary(path);
  return library;
}

class Reader {
 public:
  Reader(YamlMap& map, const MaterialLibrary& library) : map_(map), library_(library) {}

  Mesh model(const std::string& name) {
    if (name == "sphere")
      return sphere(map_.number("radius_m"), std::size_t(map_.integer("facets")),
                    material("material"));
    if (name == "cylinder")
      return cylinder(map_.number("radius_m"), map_.number("length_m"), int(map_.integer("sides")),
                      material("material"));
    if (name == "plate") {
      const auto size = sizes(map_, "size_m", 2, {1.0, 1.0});
      return plate(size[0], size[1], material("front"), material("back"));
    }
    if (name == "box-wing") return wings();
    if (name == "starlink-like")
      return starlink_like(material("chassis", "starlink-v1.5-chassis"),
                           material("front", "starlink-v1.5-array"),
                           material("back", "starlink-v1.5-array"));
    const auto size = sizes(map_, "size_m", 3, {1.0, 1.0, 1.0});
    return box({size[0], size[1], size[2]}, material("material"));
  }

 private:
  Mesh wings() {
    BoxWing size;
    const auto body = sizes(map_, "body_m", 3, {size.body_m.x, size.body_m.y, size.body_m.z});
    size.body_m = {body[0], body[1], body[2]};
    read_bound(map_, size);
    const Material body_material = material("body", "kapton");
    const auto facing_z = map_.find("body_z");
    return box_wing(size, body_material, material("front", "silicon-cell"),
                    material("back", "white-paint"),
                    facing_z ? library_.require(*facing_z) : body_material);
  }

  Material material(std::string_view key, std::string_view otherwise = "grey") {
    if (const auto value = map_.find(key)) return library_.require(*value);
    if (const auto found = library_.find(otherwise)) return *found;
    return effective_surfaces().find(otherwise).value_or(Material{});
  }

  YamlMap& map_;
  const MaterialLibrary& library_;
};

void turn_about_z(Mesh& mesh, HingedPanel& panel, double angle_rad) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  const auto turn = [&](Vec<Body>& v) { v = {c * v.x - s * v.y, s * v.x + c * v.y, v.z}; };
  for (auto& v : mesh.vertex_m) turn(v);
  for (Vec<Body>* v : {&panel.axes.hinge, &panel.axes.normal, &panel.hinge_m}) turn(*v);
}

std::string digest_of(const Mesh& mesh, bool with_panel) {
  JsonWriter json;
  json.begin_array();
  for (const auto& v : mesh.vertex_m) json.value(v.x).value(v.y).value(v.z);
  for (const auto& t : mesh.triangles)
    json.value(t.corner[0]).value(t.corner[1]).value(t.corner[2]).value(t.material);
  for (const auto& t : mesh.triangles)
    if (with_panel) json.value(int(t.panel));
  const auto write_texture = [&](const Texture& texture, double height_m) {
    json.value(texture.scale_u).value(texture.scale_v);
    json.value(texture.offset_u).value(texture.offset_v).value(int(texture.clamp)).value(height_m);
    json.value(sha256_hex({reinterpret_cast<const char*>(texture.texels.data()),
                           texture.texels.size() * sizeof(float)}));
  };
  bool textured = false;
  const auto write = [&](const Curve& curve) {
    for (const double x : curve.wavelength_m) json.value(x);
    for (const double x : curve.value) json.value(x);
  };
  for (const auto& m : mesh.materials) {
    json.value(int(m.model));
    for (const Curve* curve : {&m.reflectance, &m.emissivity, &m.diffuse, &m.specular})
      write(*curve);
    json.value(m.grazing).value(m.lobe_width).value(m.exponent);
    json.value(m.temperature_k).value(m.thermal_emissivity);
    for (const auto& texture : {m.colour_map, m.slope_map})
      if (texture) {
        write_texture(*texture, m.height_m);
        textured = true;
      }
  }
  if (textured)
    for (const auto& t : mesh.triangles)
      for (const auto& place : t.place) json.value(double(place.u)).value(double(place.v));
  return sha256_hex(json.end_array().text());
}

}  // namespace

const Section& geometry_section() {
  static const Section section{
      "geometry",
      "The shape of an object: an OBJ file, or a model with its sizes and materials "
      "(`dmise list materials`).",
      {optional("obj", form::text(), "An OBJ file beside the scenario."),
       optional("model",
                form::choice({"box", "plate", "sphere", "cylinder", "box-wing", "starlink-like"}),
                "A model, in place of the file."),
       optional("materials", form::text(), "A file of materials.", "the shipped library"),
       optional("scale", form::above(0.0, 1e6), "Factor of all lengths.", "1"),
       optional("yaw_deg", form::number(-360.0, 360.0),
                "Turns the shape and its panel about z, from x to y [deg].", "0"),
       optional("size_m", sizes(3) | sizes(2),
                "Lengths of a box along x, y, z [m], or of a plate along x, y.", "1 each"),
       optional("radius_m", size(), "Radius of a sphere or cylinder [m].", "1"),
       optional("length_m", size(), "Length of a cylinder [m].", "2"),
       optional("facets", form::integer(20, 200000), "Facets of a sphere, about.", "1280"),
       optional("sides", form::integer(3, 10000), "Sides of a cylinder.", "48"),
       optional("body_m", sizes(3), "Lengths of the body of a box-wing [m].", "[1.8, 1.6, 2]"),
       bound<&BoxWing::wing_length_m>("wing_length_m", size(), "Length of each wing, along y [m]."),
       bound<&BoxWing::wing_width_m>("wing_width_m", size(), "Width of the wings, along x [m]."),
       bound<&BoxWing::gap_m>("gap_m", form::number(0.0, largest_m), "Between body and wing [m]."),
       optional("material", form::text(), "Material of a box, sphere or cylinder.", "grey"),
       optional("front", form::text(),
                "Material of the side towards z of a plate, of wings and of an array.",
                "by the model"),
       optional("back", form::text(), "Material of their other side.", "by the model"),
       optional("body", form::text(), "Material of the body of a box-wing.", "kapton"),
       optional("body_z", form::text(),
                "Material of the side of the body of a box-wing that faces z, the Earth in nadir "
                "attitude.",
                "that of the body"),
       optional("chassis", form::text(), "Material of the chassis of a starlink-like satellite.",
                "starlink-v1.5-chassis")}};
  return section;
}

GeometryConfig read_geometry(const YamlValue& value, bool with_panel) {
  YamlMap map(value, geometry_section());
  GeometryConfig geometry;
  geometry.materials_path = find_preset("materials", "library", "");
  if (const auto materials = map.find("materials"))
    geometry.materials_path = materials->existing_file();
  const MaterialLibrary library = geometry.materials_path.empty()
                                      ? MaterialLibrary()
                                      : MaterialLibrary(geometry.materials_path);
  const auto obj = map.find("obj"), model = map.find("model");
  if (bool(obj) == bool(model)) value.fail("needs either an obj file or a model", false);
  Mesh mesh;
  if (obj) {
    geometry.obj_path = obj->existing_file();
    auto read = load_obj(
        geometry.obj_path, [&](std::string_view name) { return library.find(name); }, with_panel);
    mesh = std::move(read.mesh);
    geometry.notes = std::move(read.notes);
  } else {
    mesh = Reader(map, library).model(model->choice());
    if (model->choice() == "starlink-like") geometry.panel = starlink_like_panel();
  }
  const double scale = map.number("scale");
  mesh = scaled(std::move(mesh), scale);
  geometry.panel.hinge_m = geometry.panel.hinge_m * scale;
  if (const double yaw_deg = map.number("yaw_deg"); yaw_deg != 0.0)
    turn_about_z(mesh, geometry.panel, yaw_deg * deg);
  map.done();
  geometry.digest = digest_of(mesh, with_panel);
  geometry.mesh = std::make_shared<const Mesh>(std::move(mesh));
  return geometry;
}

}  // namespace dmise
