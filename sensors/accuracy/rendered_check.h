#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "sensors/survey/sensor_survey.h"

namespace dmise {

/// An object in a rendered frame, beside what the survey expects of it.
struct CheckedObject {
  std::string sensor;
  std::uint32_t frame = 0, catalogue_number = 0;
  ExpectedDetection look;  // forecast by the survey; zeros: it expects no light
  double signal_e = 0.0;   // its light in the frame; 0: none
  bool found = false;      // by the frame's detections
};

struct RenderedCheck {
  std::size_t frames = 0;
  std::vector<CheckedObject> objects;  // with light in the frame or the survey

  double expected() const;  // number of detections by the survey
  std::size_t found() const;
  /// Standard deviation of `found` if the survey is right: of independent detections.
  double sigma() const;
  double deviation_sigma() const;  // (found - expected) / sigma; 0 without a chance to differ
};

/// Frames with odd or even numbers: a model fitted to one half is checked with the other.
enum class FrameHalf { odd, even };

/// Renders `count` of the surveyed frames of one half, evenly over the sensors that have any and
/// over each one's frames, and detects in them as a run does. What a detection is of is decided as
/// `dmise score` does.
RenderedCheck check_rendered(const SurveyScene& scene, std::size_t count, FrameHalf half,
                             Threads& threads, const SurveyOptions& options);

/// The samples for `fitted_detection_model`.
std::vector<DetectionSample> samples_of(const RenderedCheck& check);

/// A header and a row per object: sensor, frame, number, expected and rendered electrons, SNR, ...
std::string check_csv(const RenderedCheck& check);

}  // namespace dmise
