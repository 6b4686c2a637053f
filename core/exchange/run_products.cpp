#include "core/exchange/run_products.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/nearest_name.h"
#include "core/base/paths.h"
#include "core/base/printable.h"
#include "core/base/text_file.h"
#include "core/optics/psf_table.h"
#include "core/score/json_record.h"
#include "core/score/run_files.h"
#include "core/score/wcs_record.h"
#include "core/time/iso8601.h"

namespace dmise {
namespace {

/// The Earth of the scenario.
Ellipsoid ellipsoid_of(const JsonRecord& scenario) {
  const JsonRecord simulation = scenario.object("simulation");
  if (!simulation.has("ellipsoid")) return wgs84;
  const JsonRecord own = simulation.object("ellipsoid");
  return {own.number("a_m"), own.number("f")};
}

RunSensor sensor_of(const JsonRecord& record, const Ellipsoid& ellipsoid) {
  RunSensor sensor{.name = record.get<std::string>("name"), .site = site_of(record)};
  if (!sensor.site) {
    sensor.platform = record.get<std::string>("platform");
  } else if (ellipsoid != wgs84) {
    sensor.site->ellipsoid = ellipsoid;
    sensor.site = geodetic_from_itrs(itrs_from_geodetic(*sensor.site));
  }
  const ScoredFrame camera = camera_of(record);
  if (camera.columns == 0) return sensor;  // a program of the user's
  sensor.columns = camera.columns;
  sensor.rows = camera.rows;
  sensor.psf_fwhm_px = *camera.sigma_px * fwhm_per_sigma;
  const auto effects = record.texts("effects");
  sensor.light_time = std::ranges::any_of(effects, [](const std::string& effect) {
    return effect == "light_time" || effect == "light_time!";  // by itself, or switched on
  });
  return sensor;
}

RunFrame frame_of(const JsonRecord& report, const RunSensor& sensor) {
  const auto vector = [&](const char* key) {
    const auto v = report.numbers<3>(key);
    return Vec<Gcrs>{v[0], v[1], v[2]};
  };
  RunFrame f{.sensor = sensor.name,
             .frame = report.get<std::uint32_t>("frame"),
             .start = report.time("start_ns"),
             .middle = report.time("middle_ns"),
             .end = report.time("end_ns"),
             .sensor_position_m = vector("sensor_position_gcrs_m"),
             .sensor_velocity_m_per_s = vector("sensor_velocity_gcrs_m_per_s"),
             .psf_fwhm_px = sensor.psf_fwhm_px,
             .zero_point_mag = report.number("zero_point_mag")};
  if (sensor.columns > 0) f.wcs = wcs_of(report.object("wcs"));
  const auto cd = report.object("wcs").numbers<4>("cd_deg_per_px");
  f.column_step_deg = std::hypot(cd[0], cd[2]);
  f.row_step_deg = std::hypot(cd[1], cd[3]);
  if (report.has("psf_fwhm_px") && report.number("psf_fwhm_px") > 0.0)
    f.psf_fwhm_px = report.number("psf_fwhm_px");
  return f;
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

void read_objects(const JsonRecord& record, RunProducts& run) {
  for (const JsonRecord& object : record.object("scenario").objects("objects")) {
    if (object.has("catalogue"))
      run.catalogues.push_back({.named = object.get<std::string>("catalogue"),
                                .only = object.texts("only"),
                                .sha256 = ""});
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

std::string existing(const std::string& directory, const char* name, const char* without) {
  const std::string path = directory + "/" + name;
  if (!path_exists(path)) throw ConfigError(path + ": is missing: " + without);
  return path;
}

}  // namespace

std::string RunProducts::utc(SimTime t) const { return format_utc(clock.utc(t), 9); }

const RunSensor& RunProducts::sensor(const std::string& wanted) const {
  for (const RunSensor& s : sensors)
    if (s.name == wanted) return s;
  std::vector<std::string> names;
  for (const RunSensor& s : sensors) names.push_back(s.name);
  throw ConfigError(directory + "/run.json: no sensor is named " + printable(wanted) +
                    did_you_mean(wanted, names));
}

std::size_t RunProducts::index_of(const std::string& of, std::uint32_t number) const {
  const auto found = frame_index.find({of, number});
  if (found == frame_index.end())
    throw ConfigError(directory + "/frames.jsonl: has no frame " + std::to_string(number) + " of " +
                      printable(of));
  return found->second;
}

std::map<std::uint32_t, const Track*> RunProducts::confirmed_tracks() const {
  std::map<std::uint32_t, const Track*> latest;
  for (const Track& t : tracks)
    if (t.status == TrackStatus::confirmed) latest[t.id] = &t;
  return latest;
}

std::string track_name(const Track& track) { return "TRACK " + std::to_string(track.id); }

void require_states(const RunProducts& run, const Truth& truth) {
  if (truth.true_position_m == Vec<Gcrs>{})
    throw ConfigError(run.directory +
                      "/truth.jsonl: true_position_gcrs_m: is missing: the run was made by an "
                      "earlier version");
}

RunProducts read_products(const std::string& directory, const WantedProducts& wanted,
                          const ReadProgress& progress) {
  const std::string path = existing(directory, "run.json", "no run, or one that has not ended");
  const JsonRecord record(read_text_file(path), path);
  if (record.has("status") && record.get<std::string>("status") == "begun")
    record.fail("status", "the run has not ended, or was refused at its start: got begun");
  const JsonRecord scenario = record.object("scenario");
  RunProducts run{
      .directory = directory,
      .software = record.get<std::string>("software"),
      .digest = record.get<std::string>("digest"),
      .seed = record.get<std::uint64_t>("seed"),
      .clock = Clock(parse_utc(scenario.object("simulation").get<std::string>("start")))};
  const Ellipsoid ellipsoid = ellipsoid_of(scenario);
  for (const JsonRecord& sensor : scenario.objects("sensors"))
    run.sensors.push_back(sensor_of(sensor, ellipsoid));
  read_objects(record, run);
  if (!wanted.sensor.empty()) run.sensor(wanted.sensor);
  const auto is_wanted = [&](const JsonRecord& line) {
    return wanted.sensor.empty() || line.get<std::string>("sensor") == wanted.sensor;
  };
  for_lines(existing(directory, "frames.jsonl", "the run has no frames"), progress,
            [&](const JsonRecord& line) {
              if (!is_wanted(line)) return;
              const RunFrame frame = frame_of(line, run.sensor(line.get<std::string>("sensor")));
              if (!run.frame_index.emplace(std::pair(frame.sensor, frame.frame), run.frames.size())
                       .second)
                line.fail("frame", "is there twice: " + std::to_string(frame.frame));
              run.frames.push_back(frame);
            });
  if (wanted.truth)
    for_lines(existing(directory, "truth.jsonl", "the scenario says output: {truth: false}"),
              progress, [&](const JsonRecord& line) {
                if (is_wanted(line)) run.truths.push_back(truth_of(line));
              });
  if (wanted.detections)
    for_lines(existing(directory, "detections.jsonl", "the run has no detections"), progress,
              [&](const JsonRecord& line) {
                if (is_wanted(line)) run.detections.push_back(detection_of(line));
              });
  if (wanted.tracks)
    for_lines(existing(directory, "tracks.jsonl", "the scenario has no fusion"), progress,
              [&](const JsonRecord& line) { run.tracks.push_back(track_of(line)); });
  return run;
}

}  // namespace dmise
