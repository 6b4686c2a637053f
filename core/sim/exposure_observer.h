#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <variant>
#include <vector>

#include "core/products/detection.h"
#include "core/products/frame_report.h"
#include "core/products/own_sighting.h"
#include "core/sim/state.h"

namespace dmise {

/// What a sensor of the user's is told of an exposure. All states are those of mid exposure.
struct ObserverExposure {
  std::uint32_t frame = 0;  // from 1
  SimTime start, middle, end;
  Vec<Gcrs> position_m, velocity_m_per_s;  // the sensor's
  EnvironmentState environment;
  const ObjectRoster* roster = nullptr;  // all objects; null: it is not told the truth
  ObjectStates objects = {};             // in the roster's order
};

/// Products of an exposure as they were made before.
struct ObservedBefore {
  FrameReport report;
  std::vector<Detection> detections;
};

using ObservedInExposure = std::variant<Observed, ObservedBefore>;

/// Observes in place of a camera; nothing: the run is being stopped.
using ExposureObserver = std::function<std::optional<ObservedInExposure>(const ObserverExposure&)>;

}  // namespace dmise
