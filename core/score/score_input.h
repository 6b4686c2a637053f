#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/base/files/read_progress.h"
#include "core/base/pixel.h"
#include "core/base/sim_time.h"
#include "core/products/detection.h"
#include "core/products/unknown_facts.h"

namespace dmise {

/// What is known of a source that a frame may show.
struct TrueSource {
  std::string sensor, frame, id;          // frame: its number, or the name of its file
  PixelPosition start, middle, end;       // where the source is, perhaps outside the frame
  std::optional<PixelPosition> light;     // centroid of its light in the frame; empty: it has none
  std::optional<double> signal_e;         // electrons of that light
  std::optional<double> magnitude;        // as lit
  std::optional<double> ra_rad, dec_rad;  // as `Detection::corrected_ra_rad`, at mid exposure
  std::optional<SimTime> start_time, end_time;
  bool whole = true;      // all of the trail is in the frame, and lit
  bool resolved = false;  // not a point moved along the trail
};

struct FoundSource {
  std::string sensor, frame;
  Detection detection;
  UnknownFacts unknown{};  // facts of the frame that are not known
};

struct ScoredFrame {
  std::string sensor, frame;
  int columns = 0, rows = 0;
  std::optional<double> noise_e;   // median of the noise per pixel
  std::optional<double> sigma_px;  // Gaussian nearest to the PSF, before pixel integration
  double exposure_s = 0.0;
  double solar_colour_mag = 0.0;  // magnitudes of detections less V-solar ones
  double scale_rad_per_px = 0.0;  // at the reference pixel; 0: unknown
  bool searched = true;           // detection was on
};

struct ScoreInput {
  std::string source;  // directory, for messages
  std::string status;  // how the run stands: "complete", ...
  std::vector<ScoredFrame> frames;
  std::vector<TrueSource> truths;
  std::vector<FoundSource> detections;
};

}  // namespace dmise
