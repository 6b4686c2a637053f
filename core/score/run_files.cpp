#include "core/score/run_files.h"

#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <set>

#include "core/base/error.h"
#include "core/base/text_file.h"
#include "core/base/units.h"
#include "core/optics/psf_table.h"
#include "core/score/json_record.h"

namespace dmise {
namespace {

/// Calls `take` with each whole line.
void for_lines(const std::string& path, const ReadProgress& progress,
               const std::function<void(const JsonRecord&)>& take) {
  const std::string text = read_text_file(path, std::size_t(1) << 36);
  std::size_t begin = 0, line = 1;
  for (std::size_t end; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
    if (line % 4096 == 0) progress(double(begin) / double(text.size()), path);
    take(JsonRecord(text.substr(begin, end - begin), path + ":" + std::to_string(line++)));
  }
}

/// Refuses the second of two equal names.
class Unique {
 public:
  void add(const JsonRecord& record, const char* key, const std::string& name) {
    if (!names_.insert(name).second) record.fail(key, "is there twice: " + name);
  }

 private:
  std::set<std::string> names_;
};

/// A camera of run.json, as far as it matters here.
ScoredFrame camera_of(const JsonRecord& sensor) {
  const JsonRecord camera = sensor.object("camera");
  Optics optics{.focal_length_m = camera.number("focal_length_m"),
                .aperture_m = camera.number("aperture_m"),
                .pixel_pitch_m = camera.number("pixel_pitch_m"),
                .psf_fwhm_px = camera.number("psf_fwhm_px")};
  return {.columns = camera.get<int>("columns"),
          .rows = camera.get<int>("rows"),
          .sigma_px = psf_sigma_px(optics, camera.number("band_centre_m"))};
}

TrueSource truth_of(const JsonRecord& record) {
  const auto place = [&](const char* key) {
    const auto v = record.numbers<2>(key);
    return PixelPosition{v[0], v[1]};
  };
  const double sunlit = record.number("sunlit"), signal_e = record.number("rendered_signal_e");
  const std::uint32_t number = record.get<std::uint32_t>("catalogue_number");
  TrueSource t{
      .sensor = record.get<std::string>("sensor"),
      .frame = std::to_string(record.get<std::uint32_t>("frame")),
      .id = (number > 0 ? std::to_string(number) + " " : "") + record.get<std::string>("name"),
      .start = place("start_px"),
      .middle = place("middle_px"),
      .end = place("end_px"),
      .ra_rad = record.number("true_ra_deg") * deg,
      .dec_rad = record.number("true_dec_deg") * deg,
      .start_time = record.time("start_ns"),
      .end_time = record.time("end_ns"),
      .whole = record.get<bool>("whole") && sunlit >= 1.0,
      .resolved = record.get<bool>("resolved")};
  if (record.has("rendered_px") && signal_e > 0.0) {
    t.light = place("rendered_px");
    t.signal_e = signal_e;
    if (sunlit > 0.0) t.magnitude = record.number("true_magnitude") - 2.5 * std::log10(sunlit);
  }
  // An instant at which the camera does not image the object is (0, 0): the trail goes on evenly.
  const PixelPosition none;
  if (!record.get<bool>("whole") && t.light) {
    if (t.middle == none) t.middle = *t.light;
    if (t.start == none) t.start = t.end == none ? t.middle : t.middle * 2.0 - t.end;
    if (t.end == none) t.end = t.middle * 2.0 - t.start;
  }
  return t;
}

}  // namespace

ScoredFrame frame_of(const JsonRecord& report) {
  ScoredFrame f{.sensor = report.get<std::string>("sensor"),
                .frame = std::to_string(report.get<std::uint32_t>("frame"))};
  if (report.has("noise_e") && report.number("noise_e") > 0.0) f.noise_e = report.number("noise_e");
  if (report.has("psf_fwhm_px") && report.number("psf_fwhm_px") > 0.0)
    f.sigma_px = report.number("psf_fwhm_px") / std::sqrt(8.0 * std::log(2.0));
  f.exposure_s = (report.time("end_ns") - report.time("start_ns")).seconds();
  f.searched = !report.has("detection_off") || !report.get<bool>("detection_off");
  if (!report.has("wcs")) return f;
  const auto cd = report.object("wcs").numbers<4>("cd_deg_per_px");
  f.scale_rad_per_px = std::sqrt(std::abs(cd[0] * cd[3] - cd[1] * cd[2])) * deg;
  return f;
}

ScoreInput read_run(const std::string& directory, const ReadProgress& progress) {
  ScoreInput in{.source = directory};
  const auto file = [&](const char* name) { return directory + "/" + name; };
  std::error_code ignored;
  if (!std::filesystem::exists(file("run.json"), ignored))
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
    if (!f.sigma_px) f.sigma_px = camera->second.sigma_px;
    in.frames.push_back(std::move(f));
  });
  if (!std::filesystem::exists(file("truth.jsonl"), ignored))
    throw ConfigError(file("truth.jsonl") +
                      ": is missing: the scenario says output: {truth: false}");
  for_lines(file("truth.jsonl"), progress, [&](const JsonRecord& record) {
    in.truths.push_back(truth_of(record));
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
