#include "sensors/frame/make_sensor.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/base/files/user_directories.h"
#include "core/config/make_clock.h"
#include "core/photometry/band_parts.h"
#include "core/sky/stars/shared_star_map.h"
#include "core/sky/variables/variable_stars.h"

namespace dmise {
namespace {

/// The files of a sensor without images.
OutputConfig without_images(const OutputConfig& output) {
  return {.fits = false, .png = false, .truth = output.truth};
}

}  // namespace

std::shared_ptr<const StarMap> load_stars(const Scenario& scenario) {
  if (scenario.star_catalogue_path.empty()) return nullptr;
  const auto said_at = [](const std::string& where, const auto& load) {
    try {
      return load();
    } catch (const Error& e) {
      if (where.empty()) throw;
      throw ConfigError(where + ": " + e.what());
    }
  };
  const auto map = said_at(scenario.star_catalogue_where, [&] {
    return share_star_map(scenario.star_catalogue_path, cache_directory());
  });
  if (scenario.star_variables_path.empty()) return map;
  return said_at(scenario.star_variables_where,
                 [&] { return with_variable_stars(map, scenario.star_variables_path); });
}

std::shared_ptr<const std::vector<OwnObject>> propagated_by_sensors(const Scenario& scenario) {
  if (!scenario.network.sensors_propagate) return nullptr;
  return std::make_shared<const std::vector<OwnObject>>(scenario.own_objects);
}

PipelineSettings sensor_settings(const Scenario& scenario, const std::string& name,
                                 const std::string& digest) {
  const SensorConfig& sensor = sensor_named(scenario, name);
  if (!sensor.is_camera())
    return {.sensor = sensor,
            .clock = make_clock(scenario),
            .seed = scenario.seed,
            .digest = digest,
            .shapes = nullptr,
            .propagated = nullptr};
  const auto shapes_in = [&](const Band& band) {
    return std::make_shared<const ObjectShapes>(scenario.own_objects, band, sensor.effects,
                                                models_of(scenario.objects));
  };
  std::vector<PipelineSettings::Part> parts;
  if (scenario.output.radiance_bands > 1)
    for (const Band& part : parts_of(sensor.camera.band, scenario.output.radiance_bands))
      parts.push_back({part, shapes_in(part)});
  return {.sensor = sensor,
          .clock = make_clock(scenario),
          .seed = scenario.seed,
          .digest = digest,
          .faintest_star_mag = scenario.faintest_star_mag,
          .star_truth = scenario.output.star_truth,
          .output = scenario.output,
          .shapes = shapes_in(sensor.camera.band),
          .propagated = propagated_by_sensors(scenario),
          .radiance_parts = std::move(parts)};
}

RunGrid run_grid(const Scenario& scenario) {
  return {.tick_length = scenario.tick,
          .duration = scenario.duration,
          .environment_every = sim_seconds(
              std::max(scenario.environment.common_every_s, scenario.environment.site_every_s)),
          .interpolation = scenario.interpolation,
          .cue_delay_ticks = scenario.fusion ? scenario.fusion->cue_delay_ticks : 1};
}

std::unique_ptr<SensorEvaluator> make_sensor(const Scenario& scenario, const std::string& name,
                                             const std::string& digest,
                                             const std::string& directory,
                                             std::shared_ptr<const StarMap> stars, Threads& threads,
                                             SourceFinder finder, ExposureObserver observer) {
  PipelineSettings settings = sensor_settings(scenario, name, digest);
  settings.finder = std::move(finder);
  settings.observer = std::move(observer);
  const bool has_image = settings.sensor.is_camera();
  return std::make_unique<SensorEvaluator>(
      settings, run_grid(scenario), has_image ? scenario.output : without_images(scenario.output),
      std::move(stars), directory.empty() ? "" : directory + "/" + name, threads);
}

}  // namespace dmise
