#include "core/score/run_files.h"

#include <cmath>
#include <map>
#include <set>

#include "core/base/error.h"
#include "core/base/paths.h"
#include "core/base/text_file.h"
#include "core/base/units.h"
#include "core/optics/psf_table.h"
#include "core/score/json_record.h"
#include "core/score/trail.h"

namespace dmise {
namespace {

/// Refuses the second of two equal names.
class Unique {
 public:
  void add(const JsonRecord& record, const char* key, const std::string& name) {
    if (!names_.insert(name).second) record.fail(key, "is there twice: " + name);
  }

 private:
  std::set<std::string> names_;
};

}  // namespace

TrueSource source_of(const Truth& truth) {
  const auto [start, middle, end] = places_of(truth);
  const std::uint32_t number = truth.catalogue_number;
  TrueSource t{.sensor = truth.sensor,
               .frame = std::to_string(truth.frame),
               .id = (number > 0 ? std::to_string(number) + " " : "") + truth.name,
               .start = start,
               .middle = middle,
               .end = end,
               .ra_rad = truth.true_ra_rad,
               .dec_rad = truth.true_dec_rad,
               .start_time = truth.start,
               .end_time = truth.end,
               .whole = truth.whole && truth.sunlit >= 1.0,
               .resolved = truth.resolved};
  if (truth.rendered_signal_e > 0.0) {
    t.light = PixelPosition{truth.rendered_x_px, truth.rendered_y_px};
    t.signal_e = truth.rendered_signal_e;
    if (truth.sunlit > 0.0) t.magnitude = truth.true_magnitude - 2.5 * std::log10(truth.sunlit);
  }
  return t;
}

ScoredFrame frame_of(const JsonRecord& report) {
  ScoredFrame f{.sensor = report.get<std::string>("sensor"),
                .frame = std::to_string(report.get<std::uint32_t>("frame"))};
  if (report.has("noise_e") && report.number("noise_e") > 0.0) f.noise_e = report.number("noise_e");
  if (report.has("psf_fwhm_px") && report.number("psf_fwhm_px") > 0.0)
    f.sigma_px = report.number("psf_fwhm_px") / fwhm_per_sigma;
  f.exposure_s = (report.time("end_ns") - report.time("start_ns")).seconds();
  f.searched = !report.has("detection_off") || !report.get<bool>("detection_off");
  if (report.has("solar_colour_mag")) f.solar_colour_mag = report.number("solar_colour_mag");
  if (!report.has("wcs")) return f;
  const auto cd = report.object("wcs").numbers<4>("cd_deg_per_px");
  f.scale_rad_per_px = std::sqrt(std::abs(cd[0] * cd[3] - cd[1] * cd[2])) * deg;
  return f;
}

ScoredFrame camera_of(const JsonRecord& sensor) {
  if (!sensor.has("camera")) return {};
  const JsonRecord camera = sensor.object("camera");
  Optics optics{.focal_length_m = camera.number("focal_length_m"),
                .aperture_m = camera.number("aperture_m"),
                .pixel_pitch_m = camera.number("pixel_pitch_m"),
                .psf_fwhm_px = camera.number("psf_fwhm_px")};
  return {.columns = camera.get<int>("columns"),
          .rows = camera.get<int>("rows"),
          .sigma_px = psf_sigma_px(optics, camera.number("band_centre_m"))};
}

std::optional<Site> site_of(const JsonRecord& sensor) {
  if (!sensor.has("site")) return std::nullopt;
  const JsonRecord site = sensor.object("site");
  return Site{site.number("latitude_deg"), site.number("longitude_deg"), site.number("height_m")};
}

ScoreInput read_run(const std::string& directory, const ReadProgress& progress) {
  ScoreInput in{.source = directory};
  const auto file = [&](const char* name) { return directory + "/" + name; };
  if (!path_exists(file("run.json")))
    throw ConfigError(file("run.json") + ": is missing: no run, or one that has not ended");
  const JsonRecord run(read_text_file(file("run.json")), file("run.json"));
  in.status = run.get<std::string>("status");
  std::map<std::string, ScoredFrame> cameras;
  for (const JsonRecord& sensor : run.object("scenario").objects("sensors"))
    cameras.emplace(sensor.get<std::string>("name"), camera_of(sensor));

  Unique frames, truths, detections;
  for_lines(file("frames.jsonl"), progress, [&](const JsonRecord& record) {
    ScoredFrame f = frame_of(record);
    const auto camera = cameras.find(f.sensor);
    if (camera == cameras.end()) record.fail("sensor", "is not in run.json: " + f.sensor);
    frames.add(record, "frame", f.sensor + "/" + f.frame);
    f.columns = camera->second.columns;
    f.rows = camera->second.rows;
    if (f.columns == 0) f.searched = false;  // truth is compared with images
    if (!f.sigma_px) f.sigma_px = camera->second.sigma_px;
    in.frames.push_back(std::move(f));
  });
  if (!path_exists(file("truth.jsonl")))
    throw ConfigError(file("truth.jsonl") +
                      ": is missing: the scenario says output: {truth: false}");
  for_lines(file("truth.jsonl"), progress, [&](const JsonRecord& record) {
    in.truths.push_back(source_of(truth_of(record)));
    const TrueSource& t = in.truths.back();
    truths.add(record, "name", t.sensor + "/" + t.frame + "/" + t.id);
  });
  for_lines(file("detections.jsonl"), progress, [&](const JsonRecord& record) {
    FoundSource found{.detection = detection_of(record)};
    found.sensor = found.detection.sensor;
    found.frame = std::to_string(found.detection.frame);
    detections.add(record, "id", found.detection.id);
    in.detections.push_back(std::move(found));
  });
  return in;
}

}  // namespace dmise
