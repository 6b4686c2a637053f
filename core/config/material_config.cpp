#include "core/config/material_config.h"

#include <cmath>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/config/search_path.h"

namespace dmise {
namespace {

std::vector<double> numbers(const YamlValue& value, Bounds bounds) {
  std::vector<double> all;
  for (const auto& item : value.list()) all.push_back(item.number(bounds));
  return all;
}

/// Reads a table over `wavelength_um`, or one number for all wavelengths.
Curve read_curve(const YamlValue& value, const std::vector<double>& wavelength_m) {
  const Bounds share = Bounds::between(0.0, 1.0);
  if (value.is_scalar()) return {{0.55e-6}, {value.number(share)}};
  Curve curve{wavelength_m, numbers(value, share)};
  if (curve.value.size() != wavelength_m.size())
    value.fail("must have as many numbers as wavelength_um (" +
                   std::to_string(wavelength_m.size()) + "), got " +
                   std::to_string(curve.value.size()),
               false);
  return curve;
}

std::vector<double> read_wavelengths(YamlMap& map) {
  std::vector<double> wavelength_m;
  if (const auto value = map.find("wavelength_um")) {
    for (const double w : numbers(*value, Bounds::between(0.01, 1000.0))) {
      if (!wavelength_m.empty() && w * um <= wavelength_m.back()) value->fail("must ascend", false);
      wavelength_m.push_back(w * um);
    }
  }
  return wavelength_m;
}

Material read_sandford_robertson(YamlMap& map, const std::vector<double>& wavelength_m) {
  const double grazing = map.number("grazing", Bounds::between(0.0, 10.0));
  const double lobe_width = map.number("lobe_width", Bounds::between(0.001, 1.0));
  if (const auto reflectance = map.find("reflectance"))
    return sandford_robertson_of({}, read_curve(*reflectance, wavelength_m),
                                 map.number("diffuse_share", Bounds::between(0.0, 1.0)), grazing,
                                 lobe_width);
  return {.model = Material::Model::sandford_robertson,
          .reflectance = {},
          .emissivity = read_curve(map.require("emissivity"), wavelength_m),
          .diffuse = read_curve(map.require("diffuse"), wavelength_m),
          .grazing = grazing,
          .lobe_width = lobe_width};
}

}  // namespace

Material read_material(const std::string& name, const YamlValue& value) {
  YamlMap map(value);
  const std::string model = map.require("model").choice({"lambert", "sandford-robertson", "phong"});
  const auto wavelength_m = read_wavelengths(map);
  Material m;
  if (model == "lambert") {
    m.reflectance = read_curve(map.require("reflectance"), wavelength_m);
  } else if (model == "phong") {
    m.model = Material::Model::phong;
    m.reflectance = {};
    m.diffuse = read_curve(map.require("diffuse"), wavelength_m);
    m.specular = read_curve(map.require("specular"), wavelength_m);
    m.exponent = map.number("exponent", Bounds::between(0.0, 1e5));
  } else {
    m = read_sandford_robertson(map, wavelength_m);
  }
  m.name = name;
  m.source = map.text_or("source", "");
  m.temperature_k = map.number_or("temperature_k", 0.0, Bounds::between(0.0, 3000.0));
  m.thermal_emissivity = map.number_or("thermal_emissivity", 0.0, Bounds::between(0.0, 1.0));
  map.done();
  try {
    check_material(m);
  } catch (const Error& error) {
    value.fail(error.what(), false);
  }
  return m;
}

MaterialLibrary::MaterialLibrary(const std::string& path) {
  YamlMap file(YamlValue::load(path));
  YamlMap entries(file.require("materials"));
  for (const auto& name : entries.keys())
    materials_[name] = read_material(name, entries.require(name));
  file.done();
}

const MaterialLibrary& MaterialLibrary::shipped() {
  static const MaterialLibrary library = [] {
    const std::string path = find_preset("materials", "library", "");
    return path.empty() ? MaterialLibrary() : MaterialLibrary(path);
  }();
  return library;
}

std::optional<Material> MaterialLibrary::find(std::string_view name) const {
  const auto found = materials_.find(name);
  return found == materials_.end() ? std::nullopt : std::optional(found->second);
}

Material MaterialLibrary::require(const YamlValue& value) const {
  if (auto material = find(value.text())) return *material;
  std::vector<std::string> names;
  for (const auto& [name, material] : materials_) names.push_back(name);
  const std::string near = nearest_name(value.text(), names);
  value.fail("no such material" + (near.empty() ? "" : ", did you mean " + near + "?"));
}

}  // namespace dmise
