#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>

#include "core/base/error.h"
#include "core/base/files/paths.h"
#include "core/base/files/whole_file.h"
#include "core/base/printable.h"
#include "core/config/objects/material_config.h"
#include "core/config/scenario.h"
#include "core/discrimination/discrimination_text.h"
#include "launch/command/command.h"
#include "launch/command/common_options.h"
#include "launch/run/progress.h"

namespace dmise {
namespace {

struct DiscriminateOptions {
  std::string run, design, library, plots;
  std::vector<std::string> among, sensors, known;
  Aperture aperture;
  double range_km = 2400.0, area_m2 = 1.0, right = 0.99;
  bool json = false;
  int threads = 1;
};

std::vector<Material> materials_of(const DiscriminateOptions& options) {
  const MaterialLibrary own =
      options.library.empty() ? MaterialLibrary() : MaterialLibrary(options.library);
  const MaterialLibrary& library = options.library.empty() ? MaterialLibrary::shipped() : own;
  std::vector<Material> materials;
  for (const auto& name : options.among) {
    const auto material = library.find(name);
    if (!material) throw ConfigError("--among: the library has no material " + printable(name));
    if (std::any_of(materials.begin(), materials.end(),
                    [&](const Material& m) { return m.name == name; }))
      throw ConfigError("--among: " + printable(name) + " is there twice");
    materials.push_back(*material);
  }
  if (options.among.empty())
    for (const auto& [name, material] : library.all()) materials.push_back(material);
  return materials;
}

std::map<std::string, std::string> known_of(const std::vector<std::string>& words) {
  std::map<std::string, std::string> known;
  for (const std::string& word : words) {
    const auto at = word.rfind('=');
    if (at == std::string::npos || at == 0 || at + 1 == word.size())
      throw ConfigError("--is: must be OBJECT=MATERIAL, got " + printable(word));
    if (!known.emplace(word.substr(0, at), word.substr(at + 1)).second)
      throw ConfigError("--is: " + printable(word.substr(0, at)) + " is there twice");
  }
  return known;
}

void write_chart(const std::string& directory, const char* name, const Chart& chart) {
  make_directories(directory, "--plots");
  write_file_whole(directory + "/" + name, chart_svg(chart));
}

std::string text_of_design(const DiscriminateOptions& options,
                           const std::vector<Material>& materials) {
  if (materials.size() != 2)
    throw ConfigError("--among: a design is for two materials, got " +
                      std::to_string(materials.size()));
  Scenario scenario = load_scenario(options.design);
  keep_cameras(scenario, "dmise discriminate --design");
  std::vector<const SensorConfig*> sensors;
  for (const SensorConfig& s : scenario.sensors)
    if (options.sensors.empty() ||
        std::find(options.sensors.begin(), options.sensors.end(), s.name) != options.sensors.end())
      sensors.push_back(&s);
  if (sensors.size() != 2)
    throw ConfigError(options.design + ": sensors: a design is for two bands, got " +
                      std::to_string(sensors.size()) + "; choose with --sensors");
  if (sensors[0]->camera.band.centre_m > sensors[1]->camera.band.centre_m)
    std::swap(sensors[0], sensors[1]);
  const SensorConfig& sensor = *sensors[0];
  const SpectralImager imager{.optics = sensor.camera.optics,
                              .quantum_efficiency = sensor.camera.detector.quantum_efficiency,
                              .dark_e_per_s = sensor.camera.detector.dark_e_per_s,
                              .read_noise_e = sensor.camera.detector.read_noise_e,
                              .sky_v_mag_per_arcsec2 = sensor.sky.zenith_mag_per_arcsec2,
                              .aperture_px = options.aperture.radius_px};
  const DiscriminationDesign result =
      design(imager, {.area_m2 = options.area_m2, .range_m = options.range_km * 1e3},
             {sensors[0]->camera.band, sensors[1]->camera.band}, {materials[0], materials[1]},
             options.right);
  if (!options.plots.empty()) {
    write_chart(options.plots, "design-range.svg", range_chart(result));
    write_chart(options.plots, "design-exposure.svg", exposure_chart(result));
  }
  return options.json ? design_json(result) : design_table(result);
}

std::string text_of_run(const DiscriminateOptions& options,
                        const std::vector<Material>& materials) {
  Threads threads(options.threads);
  Progress progress;
  RunSpectra spectra = measure_run(options.run, options.sensors, options.aperture, threads,
                                   [&](double share, const std::string& file) {
                                     progress.show_share(share, "discriminate: " + printable(file));
                                   });
  progress.clear_line();
  std::vector<Band> bands;
  for (const SpectralSensor& s : spectra.sensors) bands.push_back(s.band);
  std::vector<MaterialSignature> signatures;
  for (const Material& m : materials) signatures.push_back(signature_of(m, bands));
  const RunDiscrimination result =
      discriminate(std::move(spectra), signatures, known_of(options.known));
  return options.json ? discrimination_json(result) : discrimination_table(result);
}

void run_discriminate(const DiscriminateOptions& options) {
  if (options.run.empty() == options.design.empty())
    throw ConfigError("discriminate: give the directory of a run, or --design and a scenario");
  try {
    check(options.aperture);
  } catch (const Error& e) {
    throw ConfigError(e.what());
  }
  const std::vector<Material> materials = materials_of(options);
  const std::string text =
      options.run.empty() ? text_of_design(options, materials) : text_of_run(options, materials);
  std::fwrite(text.data(), 1, text.size(), stdout);
}

void add_discriminate_options(CLI::App& command) {
  auto options = std::make_shared<DiscriminateOptions>();
  auto* run = command.add_option("run", options->run, "directory of a run that has ended");
  auto* design = command.add_option("--design", options->design,
                                    "scenario with the two sensors to design, instead of a run");
  design->excludes(run);
  command.add_option("--materials", options->library,
                     "file of materials, instead of the installed library");
  command.add_option("--among", options->among, "names of the materials to compare; default: all")
      ->delimiter(',');
  command.add_option("--sensors", options->sensors, "names of the sensors; default: all")
      ->delimiter(',');
  command.add_option("--is", options->known,
                     "OBJECT=MATERIAL: what an object is known to be, for the confusion matrix");
  Aperture& aperture = options->aperture;
  add_number_option(command, "--radius-px", aperture.radius_px, 0.5, 500.0, "of the aperture");
  add_number_option(command, "--inner-px", aperture.inner_px, 0.5, 500.0,
                    "of the ring of background");
  add_number_option(command, "--outer-px", aperture.outer_px, 1.0, 500.0,
                    "of the ring of background");
  add_number_option(command, "--range-km", options->range_km, 1e-3, 1e7,
                    "distance of the object of a design")
      ->needs(design);
  add_number_option(command, "--area-m2", options->area_m2, 1e-9, 1e9,
                    "of a design's object, times its phase function")
      ->needs(design);
  add_number_option(command, "--right", options->right, 0.5001, 0.999999,
                    "probability of the right material that a design is for")
      ->needs(design);
  add_threads_option(command, options->threads);
  command.add_flag("--json", options->json, "print JSON");
  command
      .add_option("--plots", options->plots,
                  "directory: design-range.svg and design-exposure.svg of a design")
      ->needs(design);
  command.callback([options] { run_discriminate(*options); });
}

}  // namespace

Command discriminate_command() {
  return {.group = CommandGroup::frames,
          .summary = "Tells what objects are made of by their light in two bands or more",
          .details =
              "By aperture photometry in the frames of a run in orbit: the Sun's spectrum is taken "
              "out, and the materials of a library are compared. Or says which bands, exposure, "
              "aperture and distance tell two materials apart",
          .add_options = add_discriminate_options};
}

}  // namespace dmise
