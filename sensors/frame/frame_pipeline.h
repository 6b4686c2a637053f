#pragma once
#include <memory>
#include <vector>

#include "core/base/image.h"
#include "core/base/parallel.h"
#include "core/config/scenario.h"
#include "core/detection/described_sources.h"
#include "core/plan/planner.h"
#include "core/products/detection.h"
#include "core/products/frame_header.h"
#include "core/products/frame_report.h"
#include "core/products/truth.h"
#include "core/sim/exposure_observer.h"
#include "core/sky/stars/star_cache.h"
#include "core/time/clock.h"
#include "sensors/frame/frame_planes.h"
#include "sensors/light/object_light.h"
#include "sensors/light/star_layer.h"
#include "sensors/objects/object_shapes.h"
#include "sensors/objects/states_in_field.h"
#include "sensors/scene/frame_times.h"
#include "sensors/scene/state_window.h"

namespace dmise {

/// All products of one exposure.
struct FrameProducts {
  CountImage counts;
  FrameHeader header;
  FrameReport report;
  std::vector<Detection> detections;
  std::vector<Truth> truths;
  std::vector<StarTruth> stars;  // only on request, as are
  FlagImage flags;
  FramePlanes planes;
  EffectPlan plan;    // for this exposure; no effects in it: unplanned
  EffectTimes times;  // wall clock, never part of a repeatable product
  double detection_s = 0.0, total_s = 0.0;
  bool stopped = false;  // while it was searched: it has no report
};

/// Settings that all frames of a sensor share.
struct PipelineSettings {
  SensorConfig sensor;
  Clock clock;
  std::uint64_t seed = 1;
  std::string digest;  // names the run in every frame
  double faintest_star_mag = 9.5;
  bool star_truth = false;
  OutputConfig output;                         // flags and planes that are wanted
  std::shared_ptr<const ObjectShapes> shapes;  // null: all objects are points
  // The scenario's own objects, for a sensor that propagates states; null: it takes published ones.
  std::shared_ptr<const std::vector<OwnObject>> propagated;
  /// Parts of the band in which the radiance map has channels, with the surfaces in them.
  struct Part {
    Band band;
    std::shared_ptr<const ObjectShapes> shapes;
  };
  std::vector<Part> radiance_parts;
  /// Takes the light of each object alone; needs the noise among the planes of `output`.
  ObjectLightTaker object_light;
  SourceFinder finder = {};        // a detector of the user's
  ExposureObserver observer = {};  // a sensor of the user's; empty: the command starts no programs
};

/// Makes the frames of one sensor.
class FrameMaker {
 public:
  virtual ~FrameMaker() = default;

  /// Makes one frame of an exposure as it is commanded (`frame_times`). `window` holds the states
  /// from the exposure of `first_frame_for` it on. With `states` it holds ticks without states,
  /// which `states` propagates.
  virtual FrameProducts run(const FrameTimes& exposure, const StateWindow& window,
                            StatesInField* states) = 0;
  /// Takes back the counts of a finished frame, so that the next frame reuses their memory.
  virtual void give_back(CountImage&&) {}
  /// Returns the frame to expose first so that the detector is in the right state for `frame`:
  /// `frame` itself, unless an earlier one left charge in traps and was made elsewhere.
  virtual std::uint32_t first_frame_for(std::uint32_t frame) const { return frame; }
  /// Returns the most frames that a new pipeline must expose before its first one.
  virtual std::uint32_t max_frames_made_again() const { return 0; }
  /// Describes the OpenGL that draws points and sky; empty when they are deposited.
  virtual std::string evaluator() const { return ""; }
};

/// The chain of one sensor: states around an exposure -> stars, objects and sky at the focal plane
/// -> expected electrons -> electrons -> counts -> detections. Keeps its buffers between frames.
class FramePipeline : public FrameMaker {
 public:
  /// `stars` may be null: no stars. `threads` must outlive the pipeline.
  FramePipeline(PipelineSettings settings, std::shared_ptr<const StarMap> stars, Threads& threads);
  ~FramePipeline() override;

  /// With persistence a frame depends on the ones before it, which are made first where they were
  /// not.
  FrameProducts run(const FrameTimes& exposure, const StateWindow& window,
                    StatesInField* states = nullptr) override;
  void give_back(CountImage&& counts) override;
  std::uint32_t first_frame_for(std::uint32_t frame) const override;
  std::string evaluator() const override;
  std::uint32_t max_frames_made_again() const override;

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace dmise
