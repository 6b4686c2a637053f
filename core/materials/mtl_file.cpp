#include "core/materials/mtl_file.h"

#include <algorithm>
#include <array>

#include "core/base/error.h"
#include "core/materials/line_fields.h"

namespace dmise {
namespace {

using Colour = std::array<double, 3>;  // red, green, blue

/// What the lines of one `newmtl` said.
struct Entry {
  std::string name, where;
  Colour diffuse{0.2, 0.2, 0.2}, specular{};
  double exponent = 1.0;
  std::optional<Material> named;
  double temperature_k = -1.0, thermal_emissivity = -1.0;  // < 0: not said
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
  } else {
    double most = 0.0;
    for (int i = 0; i < 3; ++i) most = std::max(most, entry.diffuse[i] + entry.specular[i]);
    if (most > 1.0) {
      notes.push_back(entry.where + ": newmtl " + entry.name +
                      ": Kd + Ks above 1, scaled down to reflect no more than falls in");
      for (int i = 0; i < 3; ++i) {
        entry.diffuse[i] /= most;
        entry.specular[i] /= most;
      }
    }
    m = {.source = entry.where,
         .model = Material::Model::phong,
         .reflectance = {},
         .diffuse = curve_of(entry.diffuse),
         .specular = curve_of(entry.specular),
         .exponent = entry.exponent};
  }
  m.name = entry.name;
  if (entry.temperature_k >= 0.0) m.temperature_k = entry.temperature_k;
  if (entry.thermal_emissivity >= 0.0) m.thermal_emissivity = entry.thermal_emissivity;
  check_material(m);
  return m;
}

constexpr std::array<std::string_view, 21> without_effect{
    "Ka",    "Ke",   "Tf",    "Ni",     "illum", "sharpness", "Pr",
    "Pm",    "Ps",   "Pc",    "Pcr",    "bump",  "norm",      "disp",
    "decal", "refl", "aniso", "anisor", "Km",    "map_aat",   "map_bump"};

bool starts_with_map(std::string_view keyword) { return keyword.substr(0, 4) == "map_"; }

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
    if (!entry) fields.fail("stands before any newmtl");
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
    } else if (starts_with_map(key)) {
      notes.push_back(fields.where() + ": " + std::string(key.substr(0, 20)) +
                      ": textures are left out");
    } else if (std::find(without_effect.begin(), without_effect.end(), key) ==
               without_effect.end()) {
      fields.fail("unknown keyword");
    }
  }
  close();
  return materials;
}

}  // namespace dmise
