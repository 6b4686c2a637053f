#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/formatted.h"
#include "core/config/objects/material_config.h"
#include "core/config/objects/object_model_config.h"
#include "core/config/sensors/camera_config.h"
#include "core/config/sensors/effect_list.h"
#include "core/config/sensors/sensor_config.h"
#include "core/config/star_catalogues.h"
#include "core/config/yaml/search_path.h"
#include "core/config/yaml/yaml_reader.h"
#include "core/photometry/band.h"
#include "launch/command/command.h"

namespace dmise {
namespace {

void print(const std::string& name, const std::string& what) {
  std::printf("%-18s %s\n", name.c_str(), what.c_str());
}

/// Throws `ConfigError` if there are none: the directory is not the program's.
std::vector<std::string> names_of(const char* kind) {
  auto names = preset_names(kind);
  if (names.empty())
    throw ConfigError(home_directory() + "/launch/" + kind +
                      ": there are no files; DMISE_HOME must be the directory that launch/ is in");
  return names;
}

YamlValue preset(const char* kind, const std::string& name) {
  return YamlValue::load(find_preset(kind, name, ""));
}

void list_cameras() {
  for (const auto& name : names_of("cameras")) {
    const Camera camera = read_camera(preset("cameras", name));
    print(name, formatted("%d x %d px of %.3g um, focal length %.4g m, aperture %.3g m, %s",
                          camera.optics.columns, camera.optics.rows,
                          camera.optics.pixel_pitch_m * 1e6, camera.optics.focal_length_m,
                          camera.optics.aperture_m, camera.band.name.c_str()));
  }
}

void list_sites() {
  for (const auto& name : names_of("sites")) {
    YamlMap site(preset("sites", name), site_section());
    const double latitude_deg = site.number("latitude_deg"),
                 longitude_deg = site.number("longitude_deg");
    print(name, formatted("%.3f deg %c, %.3f deg %c, %.0f m", std::abs(latitude_deg),
                          latitude_deg < 0 ? 'S' : 'N', std::abs(longitude_deg),
                          longitude_deg < 0 ? 'W' : 'E', site.number("height_m")));
  }
}

void list_filters() {
  for (const auto& name : filter_names()) {
    const Band band = *filter_named(name);
    print(name,
          formatted("centre %.4g um, width %.3g um", band.centre_m * 1e6, band.width_m * 1e6));
  }
}

void list_materials() {
  names_of("materials");
  for (const auto& [name, material] : MaterialLibrary::shipped().all())
    print(name, material.source);
}

void list_models() {
  for (const auto& name : names_of("models")) {
    const auto model = shipped_object_model(name);
    std::string names;
    for (const auto& pattern : model->names) names += " " + pattern;
    print(name, model->source + (names.empty() ? "" : " Names:" + names));
  }
}

void list_catalogues() {
  const auto show = [](const char* name, const char* use, const char* what, const char* file,
                       const char* remedy = "DMISE_HOME is wrong") {
    const std::string path = find_catalogue(file);
    print(name, formatted("%s (%s): ", what, use) +
                    (path.empty() ? std::string("not installed; ") + remedy : path));
  };
  show("demo", "objects: [{catalogue: demo}]", "979 objects in orbit, January 2018",
       object_catalogue_file("demo"));
  show("kstars", "stars: {catalogue: kstars}", "stars to V = 9", star_catalogue_file("kstars"));
  show("tycho2", "stars: {catalogue: tycho2}", "the same and Tycho-2",
       star_catalogue_file("tycho2"), "dmise catalogue fetch tycho2 makes it");
}

void list_effects() { std::printf("%s", effects_markdown().c_str()); }

void add_list_options(CLI::App& command) {
  command.require_subcommand(1);
  const std::map<std::string, std::pair<std::string, void (*)()>> kinds{
      {"cameras", {"for sensors[].camera", list_cameras}},
      {"sites", {"for sensors[].site", list_sites}},
      {"filters", {"for a camera's band", list_filters}},
      {"materials", {"for objects[].geometry", list_materials}},
      {"models", {"for objects[].models and objects[].model", list_models}},
      {"catalogues", {"for objects[].catalogue and stars.catalogue", list_catalogues}},
      {"effects", {"for effects, as a table in Markdown", list_effects}}};
  for (const auto& [name, kind] : kinds)
    command.add_subcommand(name, kind.first)->callback(kind.second);
}

}  // namespace

Command list_command() {
  return {.group = CommandGroup::scenarios,
          .summary = "Lists names: cameras, sites, filters, materials, models, catalogues, effects",
          .add_options = add_list_options};
}

}  // namespace dmise
