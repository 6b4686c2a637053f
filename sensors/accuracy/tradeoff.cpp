#include "sensors/accuracy/tradeoff.h"

#include <time.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "core/base/error.h"
#include "core/base/formatted.h"
#include "core/base/numeric/quantile.h"
#include "core/config/sensors/effect_list.h"
#include "core/effects/frame_effects.h"
#include "core/effects/plan_facts.h"
#include "sensors/objects/objects_in_field.h"
#include "sensors/planning/exposure_planner.h"

namespace dmise {
namespace {

constexpr double not_measured = std::numeric_limits<double>::quiet_NaN();

SensorConfig planned_for(SensorConfig sensor, const Accuracy& accuracy) {
  sensor.accuracy = accuracy;
  return sensor;
}

double processor_s() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

double seconds_of(FramePipeline& chain, const SceneFrames& scene) {
  const double start_s = processor_s();
  FrameProducts frame = chain.run(scene.times(), scene.states());
  const double seconds = processor_s() - start_s;
  chain.give_back(std::move(frame.counts));
  return seconds;
}

/// Share of the objects in the frame near whose middle something was detected; NaN without any.
double share_detected(const FrameProducts& frame) {
  const double near_px = 3.0 * std::hypot(1.0, frame.header.psf_fwhm_px);
  int objects = 0, found = 0;
  for (const Truth& truth : frame.truths) {
    if (!truth.in_frame) continue;
    ++objects;
    found += std::ranges::any_of(frame.detections, [&](const Detection& d) {
      return std::hypot(d.x_px - truth.rendered_x_px, d.y_px - truth.rendered_y_px) < near_px;
    });
  }
  return objects > 0 ? double(found) / objects : not_measured;
}

/// The effects of a sensor, with the facts by which they state errors of the exposure.
struct StatedErrors {
  std::vector<PlannableEffect> effects;
  PlanFacts facts;

  ErrorBound of(const EffectFacts& effect, int level) const {
    const auto found =
        std::ranges::find(effects, &effect, [](const PlannableEffect& e) { return e.facts; });
    if (found == effects.end())
      throw Error(std::string(effect.name) + ": is no effect of this sensor's plans");
    return found->error(level, facts);
  }
};

StatedErrors stated_errors(const SceneFrames& scene, const SensorConfig& sensor) {
  const Scenario& scenario = scene.scenario();
  const ObjectShapes shapes(scenario.own_objects, sensor.camera.band, sensor.effects,
                            models_of(scenario.objects));
  const ExposurePlanner planner(sensor, scene.stars().get(), scenario.faintest_star_mag, &shapes);
  const View view(sensor, scene.times(), scene.states(), scenario.seed);
  std::vector<std::size_t> objects;
  if (sensor.effects.has(SpaceObjects::facts)) objects = objects_in_field(view, &shapes);
  SceneFacts facts = scene_facts(sensor);
  facts.stars = scene.stars() != nullptr;
  tell_shapes(facts, &shapes);
  facts.shutter_closed = view.shutter_closed();
  return {plannable_effects(sensor, facts), planner.facts(view, objects)};
}

}  // namespace

std::string tradeoff_csv_header() {
  std::string text = "effect,level";
  for (const char* which : {"bound", "measured"})
    for (const auto& kind : error_kinds) text += std::string(",") + which + "_" + kind.key;
  return text + ",residual_sigma,detected,seconds,reference_s";
}

std::string csv_line(const TradeoffRow& row) {
  std::string text = row.effect + "," + row.level;
  const auto add = [&](double value) {
    text += std::isnan(value) ? "," : formatted(",%.6g", value);
  };
  for (const auto& error : {row.bound, row.measured})
    for (const auto& kind : error_kinds) add(error.*kind.value);
  for (const double value : {row.residual_sigma, row.detected, row.seconds, row.reference_s})
    add(value);
  return text;
}

std::optional<TradeoffRow> row_of_csv(const std::string& line) {
  TradeoffRow row;
  std::istringstream text(line);
  std::vector<double> numbers;
  std::string field;
  if (!std::getline(text, row.effect, ',') || !std::getline(text, row.level, ','))
    return std::nullopt;
  while (std::getline(text, field, ',')) {
    if (field.empty()) {
      numbers.push_back(not_measured);
      continue;
    }
    char* end = nullptr;
    numbers.push_back(std::strtod(field.c_str(), &end));
    if (end == field.c_str() || *end != '\0') return std::nullopt;
  }
  constexpr std::size_t kinds = std::size(error_kinds);
  if (numbers.size() != 2 * kinds + 4) return std::nullopt;
  for (std::size_t k = 0; k < kinds; ++k) {
    row.bound.*error_kinds[k].value = numbers[k];
    row.measured.*error_kinds[k].value = numbers[kinds + k];
  }
  row.residual_sigma = numbers[2 * kinds];
  row.detected = numbers[2 * kinds + 1];
  row.seconds = numbers[2 * kinds + 2];
  row.reference_s = numbers[2 * kinds + 3];
  return row;
}

Tradeoff::Tradeoff(const SceneFrames& scene, int repeats)
    : scene_(scene),
      repeats_(repeats),
      reference_(scene.make(planned_for(scene.sensor(), reference_accuracy()))),
      comparison_(scene, reference_, reference_.plan.effects) {
  has_sources_ = std::ranges::any_of(comparison_.sources(), &ReferenceSource::counts);
  has_background_ = comparison_.background_pixels() > 0;
  const StatedErrors stated =
      stated_errors(scene, planned_for(scene.sensor(), reference_accuracy()));
  for (const PlannedEffect& effect : reference_.plan.planned) {
    if (!effect.decided) continue;
    for (int level = 0; level < effect.facts->reference(); ++level) {
      SensorConfig alone = planned_for(scene.sensor(), reference_accuracy());
      alone.unplanned = alone.effects;
      alone.effects.force_level(*effect.facts, level);
      rows_.push_back({.effect = std::string(effect.facts->name),
                       .level = std::string(effect.facts->levels[std::size_t(level)]),
                       .bound = stated.of(*effect.facts, level)});
      sensors_.push_back(std::move(alone));
    }
  }
  const auto add = [&](const std::string& name, const Accuracy& accuracy) {
    rows_.push_back({.effect = "budget", .level = name});
    sensors_.push_back(planned_for(scene.sensor(), accuracy));
  };
  add("draft", draft_accuracy());
  add("standard", standard_accuracy());
  for (double scale = 1.0 / 16.0; scale <= 64.0; scale *= 4.0) {
    Accuracy accuracy{"budget"};
    for (const auto& kind : error_kinds)
      accuracy.budget.*kind.value = scale * standard_budget.*kind.value;
    add(formatted("%g x standard", scale), accuracy);
  }
}

TradeoffRow Tradeoff::measure(std::size_t index) const {
  TradeoffRow row = rows_[index];
  const SensorConfig& sensor = sensors_[index];
  {
    const FrameProducts frame = scene_.make(sensor);
    const FrameError error = comparison_.error_of(frame, frame.plan.effects);
    if (row.effect == "budget") row.bound = frame.plan.error;
    row.measured = error.largest;
    // What is not 0 was found somewhere: in a source too faint for photometry, or in the shape of
    // the noise.
    const auto leave_out = [](double& value) {
      if (value == 0.0) value = not_measured;
    };
    if (!has_sources_) leave_out(row.measured.photometry_mag), leave_out(row.measured.position_px);
    if (!has_background_) leave_out(row.measured.background_sigma), leave_out(row.measured.noise);
    row.residual_sigma = error.residual_sigma;
    row.detected = share_detected(frame);
  }
  SensorConfig exact = planned_for(scene_.sensor(), reference_accuracy()), timed = sensor;
  exact.detect = timed.detect = false;
  auto reference = scene_.pipeline(exact, false), other = scene_.pipeline(timed, false);
  std::vector<double> seconds, reference_s;
  for (int k = 0; k < repeats_; ++k) {
    if (k > 0 && !scene_.can_repeat()) {
      reference = scene_.pipeline(exact, false);
      other = scene_.pipeline(timed, false);
    }
    reference_s.push_back(seconds_of(*reference, scene_));
    seconds.push_back(seconds_of(*other, scene_));
  }
  row.seconds = middle_of(seconds);
  row.reference_s = middle_of(reference_s);
  return row;
}

std::vector<std::string> Tradeoff::notes() const {
  std::vector<std::string> notes;
  if (!has_sources_)
    notes.push_back(
        "the frame has no isolated source: photometry_mag and position_px are not measured");
  if (!has_background_)
    notes.push_back(
        "the frame has no background pixel: background_sigma and noise are not measured");
  return notes;
}

}  // namespace dmise
