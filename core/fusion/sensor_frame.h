#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/products/detection.h"
#include "core/products/frame_report.h"
#include "core/tracking/angle_observation.h"

namespace dmise {

/// A direction in which a frame shows something.
struct SeenSource {
  AngleObservation observation;
  double magnitude = 0.0;  // `no_magnitude`: none was measured
  bool star_like = false;  // may be a star: begins no track
  bool is_point = false;   // it is no streak, of which there may be several pieces
};

/// One exposure as a fusion takes it: where it looked, how deep, and what it found.
struct SensorFrame {
  std::string sensor;
  std::uint32_t frame = 0;
  SimTime time;  // mid exposure
  Vec<Gcrs> sensor_m;
  Vec<Gcrs> axis;                   // unit: the middle of the cone that contains the field
  double half_angle_rad = 0.0;      // half the cone's opening, (0, pi]
  std::optional<Wcs> wcs;           // with columns and rows tells what is in the frame
  int columns = 0, rows = 0;        // without a wcs the cone is the field
  double resolution_rad = 0.0;      // FWHM of a point: nearer ones may blend. 0: not known
  double limiting_magnitude = 0.0;  // V-solar, as those of `sources`
  bool searched = true;             // false: nothing can be concluded from what it does not show
  bool needs_sunlight = true;       // false: it also sees what the Sun does not shine on
  std::vector<SeenSource> sources;

  /// Whether a direction is in the frame, at least `margin_px` from its edge.
  bool shows(const Vec<Gcrs>& direction, double margin_px = 0.0) const;
  /// Probability that a frame finds a source of a magnitude: `best` well above the limit, half of
  /// it at the limit, falling over half a magnitude.
  double detection_probability(double magnitude, double best) const;
  /// Solid angle of the cone [sr].
  double solid_angle_sr() const;
};

/// A frame with its detections. Those whose numbers are not usable are left out. `columns` and
/// `rows` are 0 of a sensor of the user's, which has no image and may see without sunlight.
/// `half_angle_rad`: of a cone about the boresight that contains the field. `pointing_sigma_rad`:
/// error of its directions, on each axis, that the detections' covariances lack.
SensorFrame sensor_frame(const FrameReport& report, const std::vector<Detection>& detections,
                         int columns, int rows, double half_angle_rad,
                         double pointing_sigma_rad = 0.0);

}  // namespace dmise
