#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/base/parallel.h"
#include "core/products/detection.h"

namespace dmise {

/// What `dmise check` predicts of a frame, by the published facts of its camera. Magnitudes are AB.
struct PredictedFrame {
  double zero_point_mag = 0.0;                // yields 1 e-/s, behind the air
  double sky_e = 0.0;                         // sky and dark current of a pixel
  double twilight_e = 0.0;                    // sky light by twilight
  double noise_e = 0.0;                       // noise of a pixel
  double limit_mag = 0.0;                     // magnitude of a point, above the air
  double sun_deg = 0.0, boresight_deg = 0.0;  // elevations
};

/// What the frame shows. Electrons are by the camera's published gain.
struct MeasuredFrame {
  std::optional<double> zero_point_mag;  // as above; of a calibrated frame
  std::optional<double> sky_e;           // above the bias
  std::optional<double> sky_by_noise_e;  // that its noise asks for beside read-out
  double noise_e = 0.0;
  std::optional<double> limit_mag;  // by the noise, with the predicted zero point
  std::vector<Detection> detections;
};

struct ComparedFrame {
  std::string name, camera;
  std::string about;  // sources, and what the header lacks
  std::optional<PredictedFrame> predicted;
  MeasuredFrame measured;
  int wanted_streaks = 0;  // that are in it; nothing else moves
  int streaks() const;
  bool as_wanted() const;
};

/// Compares the frames of DATA/frames. Throws `ConfigError` if one is missing.
std::vector<ComparedFrame> compare_frames(const std::string& data, Threads& threads);

/// Their section of the page in Markdown.
std::string frames_section(const std::vector<ComparedFrame>& frames);

}  // namespace dmise
