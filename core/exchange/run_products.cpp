#include "core/exchange/run_products.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/nearest_name.h"
#include "core/base/printable.h"
#include "core/optics/psf_table.h"
#include "core/products/product_json.h"
#include "core/run/run_files.h"
#include "core/time/iso8601.h"

namespace dmise {
namespace {

RunFrame frame_of(const FrameReport& report, const RunSensor& sensor) {
  RunFrame f{.sensor = sensor.name,
             .frame = report.frame,
             .start = report.start,
             .middle = report.middle,
             .end = report.end,
             .sensor_position_m = report.sensor_position_m,
             .sensor_velocity_m_per_s = report.sensor_velocity_m_per_s,
             .psf_fwhm_px = report.psf_fwhm_px > 0.0 ? report.psf_fwhm_px
                                                     : sensor.psf_sigma_px * fwhm_per_sigma,
             .zero_point_mag = report.zero_point_mag};
  const auto& cd = report.wcs.cd_deg;
  f.column_step_deg = std::hypot(cd[0], cd[2]);
  f.row_step_deg = std::hypot(cd[1], cd[3]);
  if (sensor.columns > 0) f.wcs = report.wcs;
  return f;
}

void put_on_wgs84(RunSensor& sensor) {
  if (sensor.site && sensor.site->ellipsoid != wgs84)
    sensor.site = geodetic_from_itrs(itrs_from_geodetic(*sensor.site));
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
  RunRecord record = ended_run_record(directory);
  RunProducts run{.directory = directory,
                  .software = record.software,
                  .digest = record.digest,
                  .seed = record.seed,
                  .clock = Clock(parse_utc(record.start_utc)),
                  .sensors = std::move(record.sensors),
                  .catalogues = std::move(record.catalogues),
                  .own_objects = std::move(record.own_objects)};
  for (RunSensor& sensor : run.sensors) put_on_wgs84(sensor);
  if (!wanted.sensor.empty()) run.sensor(wanted.sensor);
  const auto is_wanted = [&](const JsonRecord& line) {
    return wanted.sensor.empty() || line.get<std::string>("sensor") == wanted.sensor;
  };
  for_lines(existing_path(directory, run_file::frames), progress, [&](const JsonRecord& line) {
    if (!is_wanted(line)) return;
    const FrameReport report = report_of(line);
    const RunFrame frame = frame_of(report, run.sensor(report.sensor));
    if (!run.frame_index.emplace(std::pair(frame.sensor, frame.frame), run.frames.size()).second)
      line.fail("frame", "is there twice: " + std::to_string(frame.frame));
    run.frames.push_back(frame);
  });
  if (wanted.truth)
    for_lines(existing_path(directory, run_file::truth), progress, [&](const JsonRecord& line) {
      if (is_wanted(line)) run.truths.push_back(truth_of(line));
    });
  if (wanted.detections)
    for_lines(existing_path(directory, run_file::detections), progress,
              [&](const JsonRecord& line) {
                if (is_wanted(line)) run.detections.push_back(detection_of(line));
              });
  if (wanted.tracks)
    for_lines(existing_path(directory, run_file::tracks), progress,
              [&](const JsonRecord& line) { run.tracks.push_back(track_of(line)); });
  return run;
}

}  // namespace dmise
