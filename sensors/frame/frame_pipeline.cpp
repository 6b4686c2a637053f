#include "sensors/frame/frame_pipeline.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "core/astrometry/calibrated_detection.h"
#include "core/base/error.h"
#include "core/base/memory.h"
#include "core/base/stopwatch.h"
#include "core/config/sensors/effect_list.h"
#include "core/detection/detect.h"
#include "core/detector/exposure/expose.h"
#include "core/effects/frame_effects.h"
#include "core/image/fits_cards.h"
#include "sensors/frame/header_of.h"
#include "sensors/light/expected_electrons.h"
#include "sensors/objects/objects_in_field.h"
#include "sensors/planning/exposure_planner.h"

namespace dmise {
namespace {

template <class T, class Carrier>
std::span<std::byte> bytes_of(Image<T, Carrier>& image) {
  return std::as_writable_bytes(std::span(image.pixels));
}

/// Room for an image, in large pages from its first touch on.
template <class AnImage>
AnImage room_for_image(const Optics& optics) {
  AnImage image;
  const std::size_t size = std::size_t(optics.columns) * std::size_t(optics.rows);
  image.pixels.reserve(size);
  prefer_large_pages(std::as_writable_bytes(std::span(image.pixels.data(), size)));
  return image;
}

}  // namespace

struct FramePipeline::Work {
  PipelineSettings settings;
  Threads& threads;
  std::optional<StarLayer> stars;
  CalibratedDetector detector;
  std::optional<GlEvaluator> evaluator;
  SensorConfig planned;                    // the sensor with the effects of the exposure at hand
  std::optional<ExposurePlanner> planner;  // none: effects run as they are asked for
  std::optional<OpticsStage> optics;
  ExpectedElectronImage light;  // kept between frames: new memory costs more than filling it
  CountImage used_counts;       // left by an earlier frame: address space without memory behind it
  DetectorMemory detector_memory;
  bool made_again = false;  // the frame at hand, for what it leaves to the next

  Work(PipelineSettings s, std::shared_ptr<const StarMap> map, Threads& t)
      : settings(std::move(s)),
        threads(t),
        detector(detects_itself() ? map : nullptr),
        planned(settings.sensor) {
    detector.settings.light_curves = settings.sensor.light_curves;
    const auto& grid = settings.sensor.camera.optics;
    light = room_for_image<ExpectedElectronImage>(grid);
    light.columns = grid.columns;
    light.rows = grid.rows;
    light.pixels.resize(std::size_t(grid.columns) * std::size_t(grid.rows));
    used_counts = room_for_image<CountImage>(grid);
    if (settings.sensor.effects.drawn_by_opengl()) evaluator.emplace();
    make_optics();
    if (map) stars.emplace(settings.sensor, std::move(map), settings.faintest_star_mag);
    const bool has_plan =
        settings.sensor.accuracy.is_planned() || !settings.sensor.recorded_plans.empty();
    if (has_plan && !planned.unplanned) planned.unplanned = settings.sensor.effects;
    const auto& to_v_mag = settings.sensor.synthetic_stars_to_v_mag;
    const bool to_frame_limit = stars && to_v_mag && std::isinf(*to_v_mag);
    if (!has_plan && !to_frame_limit) return;
    planner.emplace(settings.sensor, stars ? stars->field().map().get() : nullptr,
                    settings.faintest_star_mag, settings.shapes.get());
  }

  bool detects_itself() const { return settings.sensor.detect && !settings.sensor.detector; }

  void make_optics() {
    optics.emplace(planned, settings.seed, threads);
    if (evaluator) optics->draw_by(*evaluator);
  }

  /// Sets the effects of an exposure.
  void set_effects(const EffectSet& effects) {
    const auto same_level = [&](const EffectFacts& effect) {
      return planned.effects.level(effect) == effects.level(effect);
    };
    const bool same_optics = same_level(PointSpread::facts) && same_level(AirTurbulence::facts) &&
                             same_level(PsfWavelengths::facts) && same_level(FieldBlur::facts) &&
                             same_level(FocusDrift::facts) && same_level(ReferencePixels::facts);
    planned.effects = effects;
    if (!same_optics) make_optics();
  }

  void give_back(CountImage counts) {
    used_counts = std::move(counts);
    release_pages(bytes_of(used_counts));
  }

  bool has(const EffectFacts& effect) const { return planned.effects.has(effect); }

  std::string plan(const View& view) const {
    std::string text;
    SceneFacts scene = view.scene();
    scene.stars = stars.has_value();
    tell_shapes(scene, settings.shapes.get());
    for (const EffectFacts* effect : effects_in(planned, scene)) {
      const int level = planned.effects.level(*effect);
      text += (text.empty() ? "" : " ") + std::string(effect->name);
      if (level != effect->reference())
        text += ":" + std::string(effect->levels[std::size_t(level)]);
    }
    return text;
  }

  /// What puts light on the plane, with the surfaces of objects in a band.
  LightSources sources(const StarLayer* layer, const ObjectShapes* shapes) {
    return {.stars = layer,
            .faintest_star_mag = settings.faintest_star_mag,
            .shapes = shapes,
            .evaluator = evaluator ? &*evaluator : nullptr};
  }

  /// Until they are needed again the memory is for counts.
  void release_stars() {
    if (stars)
      if (const auto& file = stars->field().map()->file) file->release();
  }

  FrameProducts make(const FrameTimes& times, const StateWindow& window);
  std::optional<DetectionResult> search(const Frame& exposed, const FrameHeader& header);
  RadianceMap radiance_in(const PipelineSettings::Part& part, const FrameTimes& times,
                          const StateWindow& window);
  std::uint32_t first_frame_for(std::uint32_t frame) const;
};

std::uint32_t FramePipeline::Work::first_frame_for(std::uint32_t frame) const {
  if (!settings.sensor.effects.has(Persistence::facts) ||
      detector_memory.persistence.next_frame == frame)
    return frame;
  return persistence_first_frame(settings.sensor.camera.detector, settings.sensor.cadence_s, frame);
}

RadianceMap FramePipeline::Work::radiance_in(const PipelineSettings::Part& part,
                                             const FrameTimes& times, const StateWindow& window) {
  SensorConfig sensor = planned;
  sensor.camera.band = part.band;
  const View view(sensor, times, window, settings.seed);
  OpticsStage part_optics(sensor, settings.seed, threads);
  if (evaluator) part_optics.draw_by(*evaluator);
  std::optional<StarLayer> part_stars;
  if (stars) part_stars.emplace(sensor, stars->field().map(), settings.faintest_star_mag);
  ExpectedElectronImage image(light.columns, light.rows);
  EffectTimes elsewhere;
  expected_electrons(view, sources(part_stars ? &*part_stars : nullptr, part.shapes.get()),
                     part_optics, image, threads, elsewhere);
  return radiance_of(view, view.times().seconds(), image, threads);
}

FramePipeline::FramePipeline(PipelineSettings settings, std::shared_ptr<const StarMap> stars,
                             Threads& threads)
    : work_(std::make_unique<Work>(std::move(settings), std::move(stars), threads)) {}

FramePipeline::~FramePipeline() = default;

std::uint32_t FramePipeline::first_frame_for(std::uint32_t frame) const {
  return work_->first_frame_for(frame);
}

std::string FramePipeline::evaluator() const {
  return work_->evaluator ? work_->evaluator->description() : "";
}

std::uint32_t FramePipeline::max_frames_made_again() const {
  const auto& sensor = work_->settings.sensor;
  const auto& detector = sensor.camera.detector;
  if (!sensor.effects.has(Persistence::facts) || !(detector.persistence_fraction > 0.0)) return 0;
  return 2 * std::min(persistence_window(detector.persistence_s, sensor.cadence_s), 1u << 30);
}

FrameProducts FramePipeline::run(const FrameTimes& times, const StateWindow& window,
                                 StatesInField* states) {
  const auto make = [&](const FrameTimes& exposure) {
    if (!states) return work_->make(exposure, window);
    const PipelineSettings& settings = work_->settings;
    return work_->make(exposure, states->around(window, settings.sensor, exposure, settings.seed));
  };
  FrameProducts frame;
  double total_s = 0.0;
  {
    Stopwatch timing(total_s);
    auto earlier = first_frame_for(times.frame);
    if (earlier < times.frame) work_->detector_memory.persistence = {};
    work_->made_again = true;
    for (; earlier < times.frame; ++earlier)
      work_->give_back(make(frame_times(work_->settings.sensor, earlier)).counts);
    work_->made_again = false;
    frame = make(times);
  }
  frame.total_s = total_s;
  return frame;
}

void FramePipeline::give_back(CountImage&& counts) { work_->give_back(std::move(counts)); }

/// What the user's detector finds in a frame, or no search; nothing if the run is being stopped.
std::optional<DetectionResult> FramePipeline::Work::search(const Frame& exposed,
                                                           const FrameHeader& header) {
  if (!settings.sensor.detect || made_again || header.shutter_closed())
    return without_detection(exposed.counts, exposed.header);
  if (!settings.finder)
    throw ConfigError(settings.sensor.detector->where + ": this command starts no programs");
  auto found = settings.finder(exposed.counts, header);
  if (!found) return std::nullopt;
  return described(std::move(*found), exposed.counts, exposed.header, threads);
}

FrameProducts FramePipeline::Work::make(const FrameTimes& times, const StateWindow& window) {
  FrameProducts frame;
  std::optional<std::vector<std::size_t>> objects;
  if (planner) {
    const View view(settings.sensor, times, window, settings.seed);
    objects.emplace();
    if (settings.sensor.effects.has(SpaceObjects::facts))
      objects = objects_in_field(view, settings.shapes.get());
    frame.plan = planner->plan(view, *objects);
    set_effects(frame.plan.effects);
  }
  const SensorConfig& sensor = planned;
  const View view(sensor, times, window, settings.seed);
  std::optional<View> believed;  // where that is not the truth
  if (view.errors().any()) believed.emplace(sensor, times, window, settings.seed, Belief::believed);
  LightSources light_sources = sources(stars ? &*stars : nullptr, settings.shapes.get());
  if (objects) light_sources.objects = &*objects;
  frame.counts = std::exchange(used_counts, {});
  const bool keeps_sky = settings.output.sources || settings.output.background;
  auto truth = expected_electrons(view, light_sources, *optics, light, threads, frame.times,
                                  {.sky = keeps_sky ? &frame.planes.background : nullptr,
                                   .stars = settings.star_truth ? &frame.stars : nullptr});
  frame.truths = std::move(truth.objects);
  if (has(StarBackground::facts)) release_stars();
  if (settings.output.radiance_exr)
    for (const auto& part : settings.radiance_parts)
      frame.planes.radiance_parts.push_back({part.band, radiance_in(part, times, window)});
  frame.header = header_of(believed ? *believed : view, settings, optics->fwhm_px());
  frame.header.excluded = view.excluded();
  // A replayed plan may leave out what has no bound in this scenario.
  if (!frame.plan.planned.empty() && std::ranges::all_of(error_kinds, [&](const ErrorKind& kind) {
        return std::isfinite(frame.plan.error.*kind.value);
      })) {
    frame.header.accuracy = frame.plan.replayed ? "replayed" : sensor.accuracy.name;
    frame.header.error = frame.plan.error;
  }
  const Exposure exposure = exposure_of(sensor, view.times(), settings.seed);
  make_planes(settings.output, view, exposure, light, threads, frame.planes);
  if (settings.object_light)
    take_object_lights(view, times, light_sources, *optics, frame.truths, frame.planes.noise,
                       threads, settings.object_light);
  expose(
      light, sensor.camera.detector, exposure, sensor.effects, threads, frame.counts, &frame.times,
      {.memory = &detector_memory, .flags = settings.output.saturation ? &frame.flags : nullptr});
  if (detects_itself()) release_pages(bytes_of(light));  // the search needs as much

  DetectionResult result;
  {
    Stopwatch timing(frame.detection_s);
    Frame exposed{std::move(frame.counts), as_in_file(frame.header)};
    if (detects_itself())
      result = detector.detect(exposed, threads).detection;
    else if (auto found = search(exposed, frame.header))
      result = std::move(*found);
    else
      frame.stopped = true;
    frame.counts = std::move(exposed.counts);
  }
  release_stars();
  frame.detections = std::move(result.detections);
  frame.report = std::move(result.report);
  frame.report.stars_rendered = truth.stars;
  for (const auto& truth : frame.truths) frame.report.objects_rendered += truth.in_frame;
  frame.report.plan = plan(view);
  return frame;
}

}  // namespace dmise
