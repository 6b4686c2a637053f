#include "sensors/accuracy/rendered_check.h"

#include <cmath>
#include <map>
#include <sstream>

#include "core/score/association.h"
#include "sensors/frame/frame_pipeline.h"
#include "sensors/frame/make_sensor.h"
#include "sensors/objects/state_window_source.h"

namespace dmise {
namespace {

constexpr double gate_px = 5.0;  // as of `dmise score`

/// Places of a frame's truths that one of its detections is of.
std::vector<bool> found_in(const FrameProducts& frame) {
  std::vector<TrueSource> truths;
  std::vector<FoundSource> detections;
  for (const Truth& t : frame.truths) {
    TrueSource source{.start = {t.start_x_px, t.start_y_px},
                      .middle = {t.middle_x_px, t.middle_y_px},
                      .end = {t.end_x_px, t.end_y_px}};
    if (t.in_frame) source.light = PixelPosition{t.rendered_x_px, t.rendered_y_px};
    truths.push_back(source);
  }
  for (const Detection& d : frame.detections) detections.push_back({.detection = d});
  std::vector<bool> found;
  for (const auto& of : associate(truths, detections, gate_px).detection_of_truth)
    found.push_back(of.has_value());
  return found;
}

/// Objects of one frame by catalogue number and name.
std::vector<CheckedObject> joined(const SurveyScene& scene, const ExposureForecast& expected,
                                  const FrameProducts& frame) {
  std::map<std::pair<std::uint32_t, std::string>, CheckedObject> by_name;
  for (const ExpectedDetection& look : expected.looks) {
    const ObjectInfo& info = scene.roster()->objects[look.object];
    by_name[{info.catalogue_number, info.name}].look = look;
  }
  const auto found = found_in(frame);
  for (std::size_t k = 0; k < frame.truths.size(); ++k) {
    const Truth& truth = frame.truths[k];
    if (!truth.in_frame) continue;
    CheckedObject& object = by_name[{truth.catalogue_number, truth.name}];
    object.signal_e = truth.rendered_signal_e;
    object.found = found[k];
  }
  std::vector<CheckedObject> objects;
  for (auto& [name, object] : by_name) {
    object.sensor = frame.report.sensor;
    object.frame = frame.report.frame;
    object.catalogue_number = name.first;
    objects.push_back(object);
  }
  return objects;
}

}  // namespace

double RenderedCheck::expected() const {
  double sum = 0.0;
  for (const auto& o : objects) sum += o.look.probability;
  return sum;
}

std::size_t RenderedCheck::found() const {
  std::size_t count = 0;
  for (const auto& o : objects) count += o.found;
  return count;
}

double RenderedCheck::sigma() const {
  double variance = 0.0;
  for (const auto& o : objects) variance += o.look.probability * (1.0 - o.look.probability);
  return std::sqrt(variance);
}

double RenderedCheck::deviation_sigma() const {
  const double s = sigma();
  return s > 0.0 ? (double(found()) - expected()) / s : 0.0;
}

RenderedCheck check_rendered(const SurveyScene& scene, std::size_t count, FrameHalf half,
                             Threads& threads, const SurveyOptions& options) {
  RenderedCheck check;
  const Scenario& scenario = scene.scenario();
  std::vector<std::pair<const SensorConfig*, std::vector<std::uint32_t>>> surveyed;
  for (const SensorConfig& sensor : scenario.sensors) {
    std::vector<std::uint32_t> frames;
    for (std::uint32_t f = half == FrameHalf::odd ? 1 : 2;
         f <= frames_within(sensor, scenario.duration); f += 2)
      if (is_surveyed(scene, sensor, f, options)) frames.push_back(f);
    if (!frames.empty()) surveyed.emplace_back(&sensor, std::move(frames));
  }
  for (std::size_t n = 0; n < surveyed.size(); ++n) {
    const auto& [sensor, all] = surveyed[n];
    const std::size_t wanted =
        std::min(all.size(), count * (n + 1) / surveyed.size() - count * n / surveyed.size());
    if (wanted == 0) continue;
    std::vector<std::uint32_t> frames;
    for (std::size_t k = 0; k < wanted; ++k)
      frames.push_back(all[std::size_t((double(k) + 0.5) * double(all.size()) / double(wanted))]);
    const ExposureForecaster looks(scene, *sensor);
    const auto objects = objects_by_frame(scene, *sensor, frames, threads);
    const StateWindowSource windows(scenario, *sensor, scene.clock());
    FramePipeline pipeline(sensor_settings(scenario, sensor->name, ""), scene.stars(), threads);
    for (std::size_t k = 0; k < frames.size(); ++k) {
      if (options.progress)
        options.progress((double(n) + double(k) / double(frames.size())) / double(surveyed.size()));
      const FrameTimes times = frame_times(*sensor, frames[k]);
      const auto expected = looks.of(times, objects[k]);
      if (!expected) continue;
      FrameProducts frame =
          pipeline.run(times, windows.around(times, scene.population(), scene.source()));
      for (auto& object : joined(scene, *expected, frame))
        check.objects.push_back(std::move(object));
      ++check.frames;
      pipeline.give_back(std::move(frame.counts));
    }
  }
  return check;
}

std::vector<DetectionSample> samples_of(const RenderedCheck& check) {
  std::vector<DetectionSample> samples;
  for (const auto& o : check.objects)
    if (o.look.probability > 0.0 || o.look.snr > 0.0) samples.push_back({o.look.trail(), o.found});
  return samples;
}

std::string check_csv(const RenderedCheck& check) {
  std::ostringstream text;
  text.precision(9);
  text << "sensor,frame,catalogue_number,expected_e,rendered_e,length_px,star_px,unlike_px,star_"
          "known,"
          "noise_e,snr,probability,found\n";
  for (const auto& o : check.objects)
    text << o.sensor << ',' << o.frame << ',' << o.catalogue_number << ',' << o.look.signal_e << ','
         << o.signal_e << ',' << o.look.length_px << ',' << o.look.star_px << ','
         << o.look.unlike_px << ',' << (o.look.star_known ? 1 : 0) << ',' << o.look.noise_e << ','
         << o.look.snr << ',' << o.look.probability << ',' << (o.found ? 1 : 0) << '\n';
  return text.str();
}

}  // namespace dmise
