#include "core/score/scored_run.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/base/files/json_record.h"
#include "core/optics/psf_table.h"
#include "core/products/product_json.h"
#include "core/run/run_files.h"
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

ScoredFrame frame_of(const FrameReport& report, const RunSensor& sensor) {
  ScoredFrame f{.sensor = sensor.name,
                .frame = std::to_string(report.frame),
                .columns = sensor.columns,
                .rows = sensor.rows,
                .exposure_s = (report.end - report.start).seconds(),
                .solar_colour_mag = report.magnitudes.solar_colour_mag,
                .scale_rad_per_px = wcs_scale_rad_per_px(report.wcs),
                .searched = !report.detection_off && sensor.columns > 0};  // compared with images
  if (report.noise_e > 0.0) f.noise_e = report.noise_e;
  if (report.psf_fwhm_px > 0.0)
    f.sigma_px = report.psf_fwhm_px / fwhm_per_sigma;
  else if (sensor.psf_sigma_px > 0.0)
    f.sigma_px = sensor.psf_sigma_px;
  return f;
}

ScoreInput read_run(const std::string& directory, const ReadProgress& progress) {
  const RunRecord run = ended_run_record(directory);
  ScoreInput in{.source = directory, .status = run.status};
  Unique frames, truths, detections;
  for_lines(existing_path(directory, run_file::frames), progress, [&](const JsonRecord& line) {
    const FrameReport report = report_of(line);
    const auto sensor = std::ranges::find(run.sensors, report.sensor, &RunSensor::name);
    if (sensor == run.sensors.end()) line.fail("sensor", "is not in run.json: " + report.sensor);
    in.frames.push_back(frame_of(report, *sensor));
    frames.add(line, "frame", report.sensor + "/" + in.frames.back().frame);
  });
  for_lines(existing_path(directory, run_file::truth), progress, [&](const JsonRecord& line) {
    in.truths.push_back(source_of(truth_of(line)));
    const TrueSource& t = in.truths.back();
    truths.add(line, "name", t.sensor + "/" + t.frame + "/" + t.id);
  });
  for_lines(existing_path(directory, run_file::detections), progress, [&](const JsonRecord& line) {
    FoundSource found{.detection = detection_of(line)};
    found.sensor = found.detection.sensor;
    found.frame = std::to_string(found.detection.frame);
    detections.add(line, "id", found.detection.id);
    in.detections.push_back(std::move(found));
  });
  return in;
}

}  // namespace dmise
