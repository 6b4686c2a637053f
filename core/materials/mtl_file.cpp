#include "core/materials/mtl_file.h"

#include <algorithm>
#include <array>
#include <charconv>

#include "core/base/error.h"
#include "core/materials/line_fields.h"
#include "core/materials/texture.h"

namespace dmise {
namespace {

using Colour = std::array<double, 3>;  // red, green, blue

/// Content of one `newmtl` block.
struct Entry {
  std::string name, where;
  std::optional<Colour> diffuse;
  Colour specular{};
  double exponent = 1.0;
  std::optional<Material> named;
  double temperature_k = -1.0, thermal_emissivity = -1.0;  // < 0: not given
  std::shared_ptr<Texture> colour_map, slope_map;
  double height_m = 1.0;
};

double ranged(const LineFields& fields, std::size_t field, double least, double most) {
  const double value = fields.number(field);
  if (!(value >= least && value <= most))
    fields.fail("must be from " + std::to_string(least) + " to " + std::to_string(most),
                fields[field]);
  return value;
}

Colour colour(const LineFields& fields) {
  if (fields.size() > 1 && (fields[1] == "spectral" || fields[1] == "xyz"))
    fields.fail("only red, green and blue can be used", fields[1]);
  if (fields.size() == 2) {
    const double grey = ranged(fields, 1, 0.0, 1.0);
    return {grey, grey, grey};
  }
  return {ranged(fields, 1, 0.0, 1.0), ranged(fields, 2, 0.0, 1.0), ranged(fields, 3, 0.0, 1.0)};
}

Curve curve_of(const Colour& c) { return {{0.45e-6, 0.55e-6, 0.61e-6}, {c[2], c[1], c[0]}}; }

Material material_of(Entry entry, std::vector<std::string>& notes) {
  Material m;
  if (entry.named) {
    m = *entry.named;
    for (const auto& map : {entry.colour_map, entry.slope_map})
      if (map) notes.push_back(map->where + ": left out: the material has a brdf of the library");
  } else {
    const double otherwise = entry.colour_map ? 1.0 : 0.2;
    Colour diffuse = entry.diffuse.value_or(Colour{otherwise, otherwise, otherwise});
    double most = 0.0;
    for (int i = 0; i < 3; ++i) most = std::max(most, diffuse[i] + entry.specular[i]);
    if (most > 1.0) {
      notes.push_back(entry.where + ": newmtl " + entry.name +
                      ": Kd + Ks above 1, scaled down to conserve energy");
      for (int i = 0; i < 3; ++i) {
        diffuse[i] /= most;
        entry.specular[i] /= most;
      }
    }
    m = {.source = entry.where,
         .model = Material::Model::phong,
         .reflectance = {},
         .diffuse = curve_of(diffuse),
         .specular = curve_of(entry.specular),
         .exponent = entry.exponent,
         .colour_map = entry.colour_map,
         .slope_map = entry.slope_map,
         .height_m = entry.height_m};
  }
  m.name = entry.name;
  if (entry.temperature_k >= 0.0) m.temperature_k = entry.temperature_k;
  if (entry.thermal_emissivity >= 0.0) m.thermal_emissivity = entry.thermal_emissivity;
  check_material(m);
  return m;
}

bool is_number(std::string_view text) {
  double value = 0.0;
  return std::from_chars(text.data(), text.data() + text.size(), value).ptr ==
         text.data() + text.size();
}

bool is_height_map(std::string_view key) {
  return key == "map_Bump" || key == "map_bump" || key == "bump";
}

/// Parses `map_Kd [options] file`; -bm sets `height_m`.
std::shared_ptr<Texture> texture_of(const LineFields& fields, double& height_m) {
  Texture t{.where = fields.where() + ": " + std::string(fields.keyword())};
  std::size_t i = 1;
  double none = 0.0;
  const auto numbers = [&](double& u, double& v) {
    u = ranged(fields, ++i, -1e4, 1e4);
    for (double* more : {&v, static_cast<double*>(nullptr)})
      if (i + 1 < fields.size() && is_number(fields[i + 1])) {
        const double value = ranged(fields, ++i, -1e4, 1e4);
        if (more) *more = value;
      }
  };
  const auto word = [&] { return ++i < fields.size() ? fields[i] : std::string_view(); };
  for (; i < fields.size() && fields[i].starts_with('-'); ++i) {
    const std::string_view option = fields[i];
    if (option == "-s")
      numbers(t.scale_u, t.scale_v);
    else if (option == "-o")
      numbers(t.offset_u, t.offset_v);
    else if (option == "-bm" && is_height_map(fields.keyword()))
      height_m = ranged(fields, ++i, -1e3, 1e3);
    else if (option == "-t")  // turbulence, which has no effect here
      numbers(none, none);
    else if (option == "-mm") {
      t.base = ranged(fields, ++i, -1e4, 1e4);
      t.gain = ranged(fields, ++i, -1e4, 1e4);
    } else if (option == "-clamp")
      t.clamp = word() == "on";
    else if (option == "-blendu" || option == "-blendv" || option == "-cc" || option == "-texres" ||
             option == "-imfchan")
      word();
    else
      fields.fail("option cannot be used", option);
  }
  for (; i < fields.size(); ++i) t.file += (t.file.empty() ? "" : " ") + std::string(fields[i]);
  if (t.file.empty()) fields.fail("needs the name of a picture");
  std::replace(t.file.begin(), t.file.end(), '\\', '/');
  return std::make_shared<Texture>(std::move(t));
}

constexpr std::array<std::string_view, 13> without_effect{
    "Ka", "Tf", "Ni", "illum", "sharpness", "Pr", "Pm", "Ps", "Pc", "Pcr", "aniso", "anisor", "Km"};

bool is_other_map(std::string_view key) {
  return key.starts_with("map_") || key == "disp" || key == "refl" || key == "norm" ||
         key == "decal";
}

}  // namespace

std::map<std::string, Material> parse_mtl(std::string_view text, const std::string& file,
                                          const MaterialByName& library,
                                          std::vector<std::string>& notes) {
  std::map<std::string, Material> materials;
  std::optional<Entry> entry;
  const auto close = [&] {
    if (entry) materials.insert_or_assign(entry->name, material_of(*entry, notes));
  };
  LineFields fields(text, file);
  while (fields.next()) {
    const std::string_view key = fields.keyword();
    if (key == "newmtl") {
      close();
      entry = Entry{.name = fields.rest(), .where = fields.where()};
      if (materials.count(entry->name)) fields.fail("defined twice", entry->name);
      continue;
    }
    if (!entry) fields.fail("precedes any newmtl");
    if (key == "Kd") {
      entry->diffuse = colour(fields);
    } else if (key == "Ks") {
      entry->specular = colour(fields);
    } else if (key == "Ns") {
      entry->exponent = ranged(fields, 1, 0.0, 1e5);
    } else if (key == "brdf") {
      entry->named = library(fields.rest());
      if (!entry->named) fields.fail("no such material in the library", fields.rest());
    } else if (key == "temperature_k") {
      entry->temperature_k = ranged(fields, 1, 0.0, 3000.0);
    } else if (key == "thermal_emissivity") {
      entry->thermal_emissivity = ranged(fields, 1, 0.0, 1.0);
    } else if (key == "d" || key == "Tr") {
      const double opaque = key == "d" ? 1.0 : 0.0;
      const std::size_t field = fields.size() > 2 && fields[1] == "-halo" ? 2 : 1;
      if (fields.number(field) != opaque)
        notes.push_back(fields.where() + ": " + std::string(key) + ": taken as opaque");
    } else if (key == "map_Kd") {
      double none = 0.0;
      entry->colour_map = texture_of(fields, none);
    } else if (is_height_map(key)) {
      entry->slope_map = texture_of(fields, entry->height_m);
    } else if (key == "Ke") {
      if (fields.size() > 1 && fields.rest().find_first_not_of("0. +-") != std::string::npos)
        notes.push_back(fields.where() + ": Ke: surfaces emit by their temperature alone");
    } else if (is_other_map(key)) {
      notes.push_back(fields.where() + ": " + std::string(key.substr(0, 20)) +
                      ": this map is left out");
    } else if (std::find(without_effect.begin(), without_effect.end(), key) ==
               without_effect.end()) {
      fields.fail("unknown keyword");
    }
  }
  close();
  return materials;
}

}  // namespace dmise
