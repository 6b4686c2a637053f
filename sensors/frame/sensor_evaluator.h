#pragma once
#include <atomic>
#include <functional>
#include <memory>
#include <string>

#include "core/config/scenario.h"
#include "core/sim/participant.h"
#include "sensors/frame/cue_journal.h"
#include "sensors/frame/frame_pipeline.h"
#include "sensors/frame/product_writer.h"

namespace dmise {

/// The grid of a run, as far as a sensor must know it.
struct RunGrid {
  SimTime tick_length, duration;
  SimTime environment_every;  // the longest time between two states of the environment
  HermiteOrder interpolation = HermiteOrder::cubic;
  Tick cue_delay_ticks = 1;  // after which a sensor hears of a task

  Tick last_tick() const { return (duration.ns + tick_length.ns - 1) / tick_length.ns; }
};

/// A sensor as an Evaluator: gathers the states of the world and, as soon as they cover an
/// exposure, makes its frame, writes its products and publishes report, detections and truth.
class SensorEvaluator : public Evaluator {
 public:
  SensorEvaluator(const PipelineSettings& settings, const RunGrid& grid, const OutputConfig& output,
                  std::shared_ptr<const StarMap> stars, std::string directory, Threads& threads);
  /// One that writes no files: `when_made` hears of its frames.
  SensorEvaluator(const PipelineSettings& settings, const RunGrid& grid,
                  std::shared_ptr<const StarMap> stars, Threads& threads);

  std::string name() const override { return sensor_.name; }
  std::vector<std::string> produces() const override;
  /// The topics that its frames need: the roster, or states, where objects are drawn, carry the
  /// sensor or are its target; the air where an effect of it acts.
  std::vector<std::string> consumes() const override;
  Tick delay(const std::string& topic) const override;
  /// All but tasks: without them a sensor that is cued stands still.
  bool needs(const std::string& topic) const override { return !topic.starts_with(task_prefix); }
  std::vector<Message> step(Tick tick, std::span<const Message> inputs) override;
  /// The ticks around the exposure that is open when it resumes, those around the frames that must
  /// be made again before it, those beyond them that interpolation takes, and back to when the
  /// environment was last published.
  Tick look_back() const override;
  std::vector<Message> resume(Tick tick, std::span<const Message> past) override;
  std::uint64_t progress() const override { return progress_; }

  /// Called between frames: true ends the step early.
  void stop_when(std::function<bool()> asked) { stop_asked_ = std::move(asked); }
  /// `told` hears of each frame when its products are written. Where nobody takes the sensor's
  /// messages, it may move from the frame what it keeps.
  void when_made(std::function<void(FrameProducts&)> told) { made_ = std::move(told); }
  int frames_done() const { return static_cast<int>(next_frame_) - 1; }
  long detections_made() const { return detections_; }
  /// Describes the OpenGL that draws points and sky; empty when they are deposited.
  std::string evaluator() const { return frames_->evaluator(); }
  /// Describes what draws objects with a shape ("OSMesa, llvmpipe ..."); empty if none was near
  /// enough.
  std::string renderer() const { return shapes_ ? shapes_->renderer_description() : ""; }

 private:
  /// Returns the tick at which all states that a frame needs are known.
  Tick ready_at(std::uint32_t frame) const;
  void take_in(std::span<const Message> inputs);
  bool is_cued() const { return std::holds_alternative<PointCued>(sensor_.pointing); }
  void take_tasks(const TaskSet& set);
  bool propagates() const { return propagated_ != nullptr; }
  void add_tick(Tick tick);

  SensorConfig sensor_;
  RunGrid grid_;
  std::uint32_t last_frame_;
  std::shared_ptr<const ObjectShapes> shapes_;
  std::unique_ptr<FrameMaker> frames_;
  std::optional<ProductWriter> writer_;
  StateWindow window_;
  std::shared_ptr<const std::vector<OwnObject>> propagated_;  // null: takes published states
  Clock clock_;
  std::optional<StatesInField> states_;             // once the roster is known
  std::vector<std::shared_ptr<const Task>> tasks_;  // that may govern an exposure, by id
  std::optional<CueJournal> cues_;
  bool begun_ = false;
  std::function<bool()> stop_asked_ = [] { return false; };
  std::function<void(FrameProducts&)> made_ = [](const FrameProducts&) {};
  std::uint32_t next_frame_ = 1;
  long detections_ = 0;
  std::atomic<std::uint64_t> progress_{0};
};

/// Throws `ConfigError`, naming sensor and key, for a platform or target that the roster does not
/// have.
void check_sensors(const Scenario& scenario, const ObjectRoster& roster);

}  // namespace dmise
