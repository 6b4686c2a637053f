#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/config/scenario.h"
#include "core/detection/described_sources.h"
#include "nodes/own/own_node_run.h"

namespace dmise {

/// A program of the user's that detects in the frames of one sensor. It is started at the first
/// frame. Under `on_silent_node: restart` a program that dies or is silent is started again, and
/// asked for the same frame.
class OwnDetector {
 public:
  /// `scenario` must outlive it; the sensor must have a detector.
  OwnDetector(const Scenario& scenario, const SensorConfig& sensor, OwnNodeSettings settings);

  /// What it finds in a frame; nothing after the stop. Throws `Error` with node, frame and tick.
  std::optional<std::vector<MeasuredSource>> find(const CountImage& counts,
                                                  const FrameHeader& header);

 private:
  std::optional<std::vector<MeasuredSource>> ask(const v1::OwnNodeFrame& frame,
                                                 const CountImage& counts);
  v1::OwnNodeFrame frame_of(const CountImage& counts, const FrameHeader& header) const;

  const Scenario& scenario_;
  OwnNode node_;
  std::string sensor_;
  OwnNodeSettings settings_;
  std::optional<OwnProgram> program_;
  OwnRestarts restarts_;
};

/// Finds sources by the detector of a sensor; empty if that is our own. The program's output goes
/// into logs/NODE-SENSOR.log of `directory`, the run's.
SourceFinder own_finder(const Scenario& scenario, const std::string& sensor,
                        const std::string& directory, OwnNodeSettings settings);

}  // namespace dmise
