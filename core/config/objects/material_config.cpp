#include "core/config/objects/material_config.h"

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/config/yaml/bound_key.h"
#include "core/config/yaml/search_path.h"
#include "core/config/yaml/yaml_reader.h"

namespace dmise {
namespace {

Forms material_share() { return form::number(0.0, 1.0); }
Forms curve() { return material_share() | form::list(material_share()); }

const Section& material_section() {
  static const Section section{
      "material",
      "How a surface reflects and emits, with curves over `wavelength_um`.",
      {required("model", form::choice({"lambert", "sandford-robertson", "phong"}),
                "The model of reflection."),
       optional("source", form::text(), "Where the numbers come from."),
       optional("wavelength_um", form::list(form::number(0.01, 1000.0)),
                "Wavelengths of the curves [um], ascending."),
       optional("reflectance", curve(), "Share of light that is reflected in all directions."),
       optional("diffuse", curve(), "Diffuse part, of phong and sandford-robertson."),
       optional("specular", curve(), "Specular part, of phong."),
       optional("exponent", form::number(0.0, 1e5), "Exponent of the lobe, of phong."),
       optional("emissivity", curve(), "Emissivity, of sandford-robertson."),
       optional("diffuse_share", material_share(),
                "Diffuse share of `reflectance`, of sandford-robertson."),
       optional("grazing", form::number(0.0, 10.0),
                "Growth towards grazing angles, of sandford-robertson."),
       optional("lobe_width", form::number(0.001, 1.0),
                "Width of the lobe, of sandford-robertson."),
       bound<&Material::temperature_k>("temperature_k", form::number(0.0, 3000.0),
                                       "Temperature of the surface [K]; 0 emits nothing."),
       bound<&Material::thermal_emissivity>("thermal_emissivity", material_share(),
                                            "Emissivity at thermal wavelengths.")}};
  return section;
}

const Section& material_list_section() {
  static const Section section{
      "materials",
      "Materials by name.",
      {},
      required("^.+$", form::map(material_section), "A material under the name that it is given.")};
  return section;
}

/// Reads a table over `wavelength_um`, or one number for all wavelengths.
Curve read_curve(const YamlValue& value, const std::vector<double>& wavelength_m) {
  if (value.is_scalar()) return {{0.55e-6}, {value.number()}};
  Curve curve{wavelength_m, value.numbers()};
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
    for (const double w : value->numbers()) {
      if (!wavelength_m.empty() && w * um <= wavelength_m.back()) value->fail("must ascend", false);
      wavelength_m.push_back(w * um);
    }
  }
  return wavelength_m;
}

Material read_sandford_robertson(YamlMap& map, const std::vector<double>& wavelength_m) {
  const double grazing = map.number("grazing");
  const double lobe_width = map.number("lobe_width");
  if (const auto reflectance = map.find("reflectance"))
    return sandford_robertson_of({}, read_curve(*reflectance, wavelength_m),
                                 map.number("diffuse_share"), grazing, lobe_width);
  return {.model = Material::Model::sandford_robertson,
          .reflectance = {},
          .emissivity = read_curve(map.require("emissivity"), wavelength_m),
          .diffuse = read_curve(map.require("diffuse"), wavelength_m),
          .grazing = grazing,
          .lobe_width = lobe_width};
}

}  // namespace

const Section& material_library_section() {
  static const Section section{
      "material-library",
      "A file of materials.",
      {required("materials", form::map(material_list_section), "The materials, by name.")}};
  return section;
}

Material read_material(const std::string& name, const YamlValue& value) {
  YamlMap map(value, material_section());
  const std::string model = map.require("model").choice();
  const auto wavelength_m = read_wavelengths(map);
  Material m;
  if (model == "lambert") {
    m.reflectance = read_curve(map.require("reflectance"), wavelength_m);
  } else if (model == "phong") {
    m.model = Material::Model::phong;
    m.reflectance = {};
    m.diffuse = read_curve(map.require("diffuse"), wavelength_m);
    m.specular = read_curve(map.require("specular"), wavelength_m);
    m.exponent = map.number("exponent");
  } else {
    m = read_sandford_robertson(map, wavelength_m);
  }
  m.name = name;
  if (const auto source = map.find("source")) m.source = source->text();
  read_bound(map, m);
  map.done();
  try {
    check_material(m);
  } catch (const Error& error) {
    value.fail(error.what(), false);
  }
  return m;
}

MaterialLibrary::MaterialLibrary(const std::string& path) {
  YamlMap file(YamlValue::load(path), material_library_section());
  YamlMap entries(file.require("materials"), material_list_section());
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
  value.fail("no such material" + did_you_mean(value.text(), names));
}

}  // namespace dmise
