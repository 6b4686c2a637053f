#include "sensors/frame/sensor_evaluator.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/base/printable.h"
#include "core/effects/frame_effects.h"
#include "core/sky/air/air_effects.h"
#include "core/sky/places/place_effects.h"
#include "sensors/frame/observed_frames.h"
#include "sensors/scene/cue_path.h"

namespace dmise {
namespace {

std::unique_ptr<FrameMaker> frame_maker(const PipelineSettings& settings,
                                        std::shared_ptr<const StarMap> stars, Threads& threads) {
  if (!settings.sensor.is_camera()) return std::make_unique<ObservedFrames>(settings);
  return std::make_unique<FramePipeline>(settings, std::move(stars), threads);
}

}  // namespace

SensorEvaluator::SensorEvaluator(const PipelineSettings& settings, const RunGrid& grid,
                                 const OutputConfig& output, std::shared_ptr<const StarMap> stars,
                                 std::string directory, Threads& threads)
    : SensorEvaluator(settings, grid, std::move(stars), threads) {
  if (directory.empty()) return;
  if (is_cued()) cues_.emplace(directory);
  writer_.emplace(std::move(directory), output, settings.clock);
}

SensorEvaluator::SensorEvaluator(const PipelineSettings& settings, const RunGrid& grid,
                                 std::shared_ptr<const StarMap> stars, Threads& threads)
    : sensor_(settings.sensor),
      grid_(grid),
      last_frame_(frames_within(settings.sensor, grid.duration)),
      shapes_(settings.shapes),
      frames_(frame_maker(settings, std::move(stars), threads)),
      window_(grid.interpolation, grid.last_tick()),
      propagated_(settings.propagated),
      clock_(settings.clock) {}

Tick SensorEvaluator::ready_at(std::uint32_t frame) const {
  return tick_needed(grid_.interpolation, exposure_span(sensor_, frame).end, grid_.tick_length,
                     grid_.last_tick());
}

std::vector<std::string> SensorEvaluator::produces() const {
  return {frame_prefix + sensor_.name, detection_prefix + sensor_.name,
          truth_prefix + sensor_.name};
}

std::vector<std::string> SensorEvaluator::consumes() const {
  if (!sensor_.is_camera())
    return takes_states(sensor_) ? std::vector<std::string>{objects_topic, environment_topic}
                                 : std::vector<std::string>{environment_topic};
  const EffectSet& effects = sensor_.effects;
  const bool on_ground = std::holds_alternative<SiteConfig>(sensor_.place);
  std::vector<std::string> topics;
  if (effects.has(SpaceObjects::facts) || !on_ground ||
      std::holds_alternative<PointTarget>(sensor_.pointing)) {
    topics.push_back(propagates() ? roster_topic : objects_topic);
    if (propagates())
      for (auto& topic : actor_topics(*propagated_)) topics.push_back(std::move(topic));
  }
  topics.push_back(environment_topic);
  if (on_ground &&
      (effects.has(AtmosphericRefraction::facts) || effects.has(AirExtinction::facts) ||
       effects.has(SkyBackground::facts) || sensor_.atmosphere.turbulence))
    topics.push_back(site_prefix + sensor_.name);
  if (is_cued()) topics.push_back(task_prefix + sensor_.name);
  return topics;
}

Tick SensorEvaluator::delay(const std::string& topic) const {
  return topic.starts_with(task_prefix) ? grid_.cue_delay_ticks : 0;
}

/// A task does not begin before the tick at which it is heard of: to know it earlier, from the
/// journal, changes nothing.
void SensorEvaluator::take_tasks(const TaskSet& set) {
  for (const Task& task : set.tasks) {
    if (!tasks_.empty() && task.id <= tasks_.back()->id) continue;
    tasks_.push_back(std::make_shared<const Task>(task));
    if (cues_) cues_->add(task);
  }
}

void SensorEvaluator::take_in(std::span<const Message> inputs) {
  for (const auto& message : inputs) {
    if (propagates() && std::holds_alternative<ObjectRoster>(*message.state)) {
      const auto objects =
          propagated_objects(message.state, *propagated_, clock_, sensor_.ellipsoid,
                             shapes_ ? shapes_->models() : ObjectModels());
      window_.add(std::shared_ptr<const ObjectRoster>(objects, &objects->population.roster));
      states_.emplace(objects, grid_.tick_length);
    } else if (const auto* set = std::get_if<TaskSet>(message.state.get())) {
      take_tasks(*set);
    } else if (!states_ || !states_->tell(message)) {
      window_.add(message.state);
    }
  }
}

void SensorEvaluator::add_tick(Tick tick) {
  if (propagates()) window_.add_tick(tick, {tick * grid_.tick_length.ns});
}

Tick SensorEvaluator::look_back() const {
  SimTime exposure;  // the longest: a clock's error grows evenly
  for (const std::uint32_t frame : {1u, std::max(1u, last_frame_)}) {
    const ExposureSpan span = exposure_span(sensor_, frame);
    exposure = std::max(exposure, span.end - span.start);
  }
  const auto frames = std::min(frames_->max_frames_made_again(), last_frame_);
  const SimTime earlier{frames * sim_seconds(sensor_.cadence_s).ns};
  const std::int64_t ns = exposure.ns + earlier.ns + grid_.environment_every.ns;
  const Tick beyond = knots(grid_.interpolation) - 2;  // on either side of the exposure
  return (ns + grid_.tick_length.ns - 1) / grid_.tick_length.ns + 1 + 2 * beyond;
}

std::vector<Message> SensorEvaluator::resume(Tick tick, std::span<const Message> past) {
  if (cues_) tasks_ = cues_->resume();
  begun_ = true;
  take_in(past);
  for (Tick before = std::max<Tick>(0, tick - look_back()); before < tick; ++before)
    add_tick(before);
  // Frames that were not ready at the last tick made before are still to be made: none that ends
  // after it is.
  next_frame_ = tick == 0 ? 1 : frames_within(sensor_, {(tick - 1) * grid_.tick_length.ns}) + 1;
  next_frame_ = std::min(next_frame_, last_frame_ + 1);
  while (next_frame_ > 1 && ready_at(next_frame_ - 1) >= tick) --next_frame_;
  if (writer_) detections_ = writer_->keep_frames(next_frame_ - 1);
  return {};
}

std::vector<Message> SensorEvaluator::step(Tick tick, std::span<const Message> inputs) {
  if (!std::exchange(begun_, true) && cues_) cues_->clear();
  take_in(inputs);
  add_tick(tick);
  std::vector<Message> messages;
  while (next_frame_ <= last_frame_ && !stop_asked_()) {
    const FrameTimes exposure = frame_times(sensor_, next_frame_);
    if (ready_at(next_frame_) > tick) {
      window_.forget_before(exposure_span(sensor_, frames_->first_frame_for(next_frame_)).start);
      if (states_) states_->forget_before(window_.first_tick());
      break;
    }
    if (is_cued()) {
      const Task* task = task_during(tasks_, exposure.start, exposure.end);
      if (!task) {
        ++next_frame_;
        continue;
      }
      window_.follow(*std::ranges::find(tasks_, task, &std::shared_ptr<const Task>::get));
    }
    FrameProducts frame = frames_->run(exposure, window_, states_ ? &*states_ : nullptr);
    if (frame.stopped) break;
    if (writer_) writer_->write(frame);
    made_(frame);
    frames_->give_back(std::move(frame.counts));
    detections_ += static_cast<long>(frame.detections.size());
    messages.push_back(
        {frame_prefix + sensor_.name, tick, std::make_shared<State>(std::move(frame.report))});
    messages.push_back({detection_prefix + sensor_.name, tick,
                        std::make_shared<State>(DetectionSet{sensor_.name, exposure.frame,
                                                             std::move(frame.detections)})});
    messages.push_back(
        {truth_prefix + sensor_.name, tick,
         std::make_shared<State>(TruthSet{sensor_.name, exposure.frame, std::move(frame.truths)})});
    ++next_frame_;
    ++progress_;
  }
  if (cues_ && !stop_asked_()) cues_->end(tick);
  ++progress_;
  return messages;
}

void check_sensors(const Scenario& scenario, const ObjectRoster& roster) {
  for (const auto& sensor : scenario.sensors) {
    const auto at = [&](const std::string& where, const char* key) {
      return where.empty() ? scenario.path + ": sensors." + sensor.name + key : where;
    };
    if (const auto* platform = std::get_if<PlatformConfig>(&sensor.place)) {
      const auto index = object_index(roster, platform->object, at(platform->where, ".platform"));
      const auto has_attitude = [&](const OwnObject& own) {
        return own.attitude && own.catalogue_number == roster.objects[index].catalogue_number;
      };
      if (std::holds_alternative<PointBody>(sensor.pointing) &&
          std::none_of(scenario.own_objects.begin(), scenario.own_objects.end(), has_attitude))
        throw ConfigError((sensor.where.empty() ? at("", "") : sensor.where) +
                          ".pointing.body: the platform must be an object with an attitude, got " +
                          printable(platform->object));
    }
    if (const auto* target = std::get_if<PointTarget>(&sensor.pointing)) {
      const std::string where = at(target->where, ".pointing.target");
      const auto index = object_index(roster, target->object, where);
      const auto* platform = std::get_if<PlatformConfig>(&sensor.place);
      if (platform && object_index(roster, platform->object, where) == index)
        throw ConfigError(where + ": is the sensor's own platform, got " +
                          printable(target->object));
    }
  }
}

}  // namespace dmise
