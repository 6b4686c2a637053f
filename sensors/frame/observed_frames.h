#pragma once
#include <optional>

#include "core/visibility/pointing.h"
#include "sensors/frame/frame_pipeline.h"

namespace dmise {

/// Frames without an image, of a sensor that is a program of the user's: the report of each
/// exposure, and a detection of each of its sightings.
class ObservedFrames : public FrameMaker {
 public:
  explicit ObservedFrames(const PipelineSettings& settings);

  FrameProducts run(const FrameTimes& exposure, const StateWindow& window,
                    StatesInField* states) override;

 private:
  FrameProducts make(const FrameTimes& exposure, const StateWindow& window) const;
  FrameProducts products_of(const FrameTimes& exposure, const StateWindow& window,
                            const ObserverExposure& told, Observed observed) const;
  /// Index of the object that carries it, which has a state throughout the exposure.
  std::optional<std::size_t> platform(const FrameTimes& exposure, const StateWindow& window) const;
  ObserverExposure exposure_of(const FrameTimes& exposure, const StateWindow& window) const;
  FrameReport report_of(const FrameTimes& exposure, const ObserverExposure& told,
                        const Observed& observed) const;

  SensorConfig sensor_;
  ExposureObserver observer_;
};

}  // namespace dmise
