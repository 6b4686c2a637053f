#include "core/run/run_record.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/base/files/paths.h"
#include "core/base/files/text_file.h"
#include "core/base/printable.h"
#include "core/optics/psf_table.h"
#include "core/orbit/breakup/breakup.h"
#include "core/orbit/debris/debris_population.h"
#include "core/orbit/sgp4/walker.h"
#include "core/run/run_files.h"
#include "core/time/iso8601.h"

namespace dmise {
namespace {

std::string text_or_empty(const JsonRecord& record, const char* key) {
  return record.get_or<std::string>(key, "");
}

std::optional<Site> site_of(const JsonRecord& sensor, const Ellipsoid& ellipsoid) {
  if (!sensor.has("site")) return std::nullopt;
  const JsonRecord site = sensor.object("site");
  return Site{.latitude_deg = site.number("latitude_deg"),
              .longitude_deg = site.number("longitude_deg"),
              .height_m = site.number("height_m"),
              .ellipsoid = ellipsoid};
}

Ellipsoid ellipsoid_of(const JsonRecord& scenario) {
  if (!scenario.has("simulation")) return wgs84;
  const JsonRecord simulation = scenario.object("simulation");
  if (!simulation.has("ellipsoid")) return wgs84;
  const JsonRecord own = simulation.object("ellipsoid");
  return {own.number("a_m"), own.number("f")};
}

void read_camera(const JsonRecord& camera, RunSensor& sensor) {
  const Optics optics{.focal_length_m = camera.number("focal_length_m"),
                      .aperture_m = camera.number("aperture_m"),
                      .pixel_pitch_m = camera.number("pixel_pitch_m"),
                      .psf_fwhm_px = camera.number("psf_fwhm_px")};
  sensor.camera = text_or_empty(camera, "name");
  sensor.columns = camera.get<int>("columns");
  sensor.rows = camera.get<int>("rows");
  sensor.psf_sigma_px = psf_sigma_px(optics, camera.number("band_centre_m"));
  sensor.camera_keys = camera;
}

RunSensor sensor_of(const JsonRecord& record, const Ellipsoid& ellipsoid) {
  RunSensor sensor{.name = record.get<std::string>("name"),
                   .site = site_of(record, ellipsoid),
                   .platform = text_or_empty(record, "platform"),
                   .camera = "node " + text_or_empty(record, "node"),
                   .exposure_s = record.get_or("exposure_s", 0.0),
                   .cadence_s = record.get_or("cadence_s", 0.0)};
  if (const std::string& name = sensor.name;
      name.empty() || name.find('/') != std::string::npos || name.starts_with('.'))
    record.fail("name", "can't be the name of a directory: " + printable(name));
  if (record.has("camera")) read_camera(record.object("camera"), sensor);
  if (record.has("camera") && record.has("effects"))
    sensor.light_time = std::ranges::any_of(record.texts("effects"), [](const std::string& effect) {
      return effect == "light_time" || effect == "light_time!";  // by itself, or switched on
    });
  return sensor;
}

/// Elements of an object of the scenario; run.json has no more of its element set.
MeanElements elements_of(const JsonRecord& object) {
  const auto v = object.numbers<9>("sgp4");
  return {.catalogue_number = object.get<std::uint32_t>("catalogue_number"),
          .name = object.get<std::string>("name"),
          .epoch_jd1 = v[0],
          .epoch_jd2 = v[1],
          .mean_motion_rad_per_min = v[2],
          .eccentricity = v[3],
          .inclination_rad = v[4],
          .raan_rad = v[5],
          .argument_of_perigee_rad = v[6],
          .mean_anomaly_rad = v[7],
          .bstar_per_earth_radius = v[8]};
}

Walker walker_of(const JsonRecord& object) {
  const auto v = object.numbers<8>("orbit");
  const Walker walker{.name = object.get<std::string>("walker"),
                      .first_number = object.get<std::uint32_t>("first_number"),
                      .planes = object.get<int>("planes"),
                      .per_plane = object.get<int>("per_plane"),
                      .phasing = object.get<int>("phasing"),
                      .semi_major_axis_m = v[0],
                      .inclination_rad = v[1],
                      .raan_spread_rad = v[2],
                      .raan_rad = v[3],
                      .argument_of_latitude_rad = v[4],
                      .spacing_s = v[7],
                      .epoch = {v[5], v[6]}};
  if (walker.planes < 1 || walker.per_plane < 1 ||
      walker.planes > max_walker_satellites / walker.per_plane)
    object.fail("planes", "a constellation has 1 to " + std::to_string(max_walker_satellites) +
                              " satellites");
  return walker;
}

Breakup breakup_of(const JsonRecord& object) {
  const auto event = object.numbers<5>("event");
  const auto v = object.numbers<8>("teme");
  const Breakup breakup{
      .name = object.get<std::string>("breakup"),
      .first_number = object.get<std::uint32_t>("first_number"),
      .event = {.kind =
                    object.get<bool>("collision") ? BreakupKind::collision : BreakupKind::explosion,
                .structure = object.get<bool>("spacecraft") ? BrokenStructure::spacecraft
                                                            : BrokenStructure::upper_stage,
                .mass_kg = event[0],
                .scale = event[1],
                .projectile_mass_kg = event[2],
                .relative_speed_m_per_s = event[3],
                .min_length_m = event[4]},
      .seed = object.has("seed") ? std::optional(object.get<std::uint64_t>("seed")) : std::nullopt,
      .parent = {{v[2], v[3], v[4]}, {v[5], v[6], v[7]}},
      .epoch = {v[0], v[1]}};
  const double pieces = pieces_over(breakup.event, breakup.event.min_length_m);
  if (!(pieces >= 1.0 && pieces < max_fragments + 1.0))
    object.fail("event", "a breakup has 1 to " + std::to_string(max_fragments) + " fragments");
  return breakup;
}

Utc start_of(const RunRecord& run, const JsonRecord& object) {
  try {
    return parse_utc(run.start_utc);
  } catch (const ConfigError& e) {
    object.fail("breakup", std::string("the run's start: ") + e.what());
  }
}

DebrisPopulation population_of(const JsonRecord& object) {
  const auto v = object.numbers<9>("debris");
  const auto counts = object.numbers<180>("inclinations");
  DebrisPopulation population{
      .name = object.get<std::string>("population"),
      .first_number = object.get<std::uint32_t>("first_number"),
      .year = v[0],
      .solar_flux_sfu = v[1],
      .scale = v[2],
      .min_size_m = v[3],
      .max_size_m = v[4],
      .min_height_m = v[5],
      .max_height_m = v[6],
      .seed = object.has("seed") ? std::optional(object.get<std::uint64_t>("seed")) : std::nullopt,
      .epoch = {v[7], v[8]}};
  for (std::size_t degree = 0; degree < counts.size(); ++degree)
    population.inclinations[degree] = int(std::clamp(counts[degree], 0.0, 1e6));
  const bool sizes = v[3] >= 1e-3 && v[3] < v[4] && v[4] <= 10.0;
  const bool shell = v[5] >= 0.0 && v[5] < v[6] && v[6] <= 1e7;
  if (!sizes || !shell || !(population.mean_count() <= max_debris_objects))
    object.fail("debris", "a population has up to " + std::to_string(max_debris_objects) +
                              " objects within a shell");
  return population;
}

void read_objects(const JsonRecord& record, const JsonRecord& scenario, RunRecord& run) {
  if (!scenario.has("objects")) return;
  const auto add_made = [&](const MeanElements& e) {
    run.own_objects.push_back({.catalogue_number = e.catalogue_number, .elements = e});
  };
  for (const JsonRecord& object : scenario.objects("objects")) {
    if (object.has("catalogue"))
      run.catalogues.push_back({.named = object.get<std::string>("catalogue"),
                                .only = object.texts("only"),
                                .sha256 = ""});
    else if (object.has("walker"))
      for (const MeanElements& e : elements_of(walker_of(object))) add_made(e);
    else if (object.has("breakup"))
      for (const MeanElements& e :
           fragments_of(breakup_of(object), run.seed, start_of(run, object)).elements)
        add_made(e);
    else if (object.has("population"))
      for (const MeanElements& e : draw_debris(population_of(object), run.seed).elements)
        add_made(e);
    else
      run.own_objects.push_back(
          {.catalogue_number = object.get<std::uint32_t>("catalogue_number"),
           .elements = object.has("sgp4") ? std::optional(elements_of(object)) : std::nullopt});
  }
  if (!record.has("catalogue_sha256")) return;
  const auto digests = record.texts("catalogue_sha256");
  if (digests.size() != run.catalogues.size())
    record.fail("catalogue_sha256", "is not one for each catalogue of the scenario");
  for (std::size_t i = 0; i < digests.size(); ++i) run.catalogues[i].sha256 = digests[i];
}

void read_scenario(const JsonRecord& record, RunRecord& run) {
  const JsonRecord scenario = record.object("scenario");
  run.seed = record.get_or<std::uint64_t>("seed", 0);
  if (scenario.has("simulation")) {
    const JsonRecord simulation = scenario.object("simulation");
    run.start_utc = simulation.get<std::string>("start");
    run.duration = simulation.time("duration_ns");
    run.tick = simulation.time("tick_ns");
  }
  if (scenario.has("stars"))
    run.star_catalogue = text_or_empty(scenario.object("stars"), "catalogue");
  const Ellipsoid ellipsoid = ellipsoid_of(scenario);
  for (const JsonRecord& sensor : scenario.objects("sensors"))
    run.sensors.push_back(sensor_of(sensor, ellipsoid));
  read_objects(record, scenario, run);
}

RunRecord run_of(const JsonRecord& record, const std::string& path) {
  RunRecord run{.path = path,
                .status = record.get<std::string>("status"),
                .how = text_or_empty(record, "how"),
                .reason = text_or_empty(record, "reason"),
                .software = text_or_empty(record, "software"),
                .digest = text_or_empty(record, "digest"),
                .parts = record.get_or("parts", 1)};
  if (record.has("dropped")) run.dropped = record.texts("dropped");
  if (record.has("wall_s")) run.wall_s = record.number("wall_s");
  if (record.has("nodes"))
    for (const JsonRecord& node : record.objects("nodes"))
      run.nodes.push_back({.name = node.get<std::string>("name"),
                           .compute_s = node.get_or("compute_s", 0.0),
                           .messaging_s = node.get_or("messaging_s", 0.0),
                           .waiting_s = node.get_or("waiting_s", 0.0),
                           .start_s = node.get_or("start_s", 0.0)});
  if (record.has("scenario")) read_scenario(record, run);
  return run;
}

}  // namespace

std::optional<RunRecord> read_run_record(const std::string& directory) {
  const std::string path = path_in(directory, run_file::record);
  if (!path_exists(path)) return std::nullopt;
  return run_of(JsonRecord(read_text_file(path), path), path);
}

RunRecord ended_run_record(const std::string& directory) {
  const std::string path = existing_path(directory, run_file::record);
  const JsonRecord record(read_text_file(path), path);
  if (record.get<std::string>("status") == "begun")
    record.fail("status", "the run has not ended, or was refused at its start: got begun");
  if (!record.has("scenario")) record.fail("scenario", "is missing");
  return run_of(record, path);
}

std::map<std::string, FrameLevels> read_planned_levels(const std::string& run_json) {
  std::map<std::string, FrameLevels> levels;
  const JsonRecord record(read_text_file(run_json), printable(run_json));
  for (const JsonRecord& frame : record.objects("frames")) {
    if (!frame.has("plan")) continue;
    auto& of_frame = levels[frame.get<std::string>("sensor")][frame.get<std::uint32_t>("frame")];
    for (const auto& [effect, planned] : frame.object("plan").object("effects").all_objects())
      of_frame[effect] = planned.get<std::string>("level");
  }
  return levels;
}

}  // namespace dmise
