#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "core/base/sim_time.h"
#include "core/frames/quaternion.h"
#include "core/frames/vec.h"

namespace dmise {

/// True state of one object in one frame: `true_*` by the full physics, `rendered_*` as drawn.
/// Published on its own endpoint; only a scorer combines it with detections.
struct Truth {
  std::string sensor;
  std::uint32_t frame = 0;
  std::uint32_t catalogue_number = 0;
  std::string name;
  SimTime start, middle, end;                        // of the exposure, as it was
  Vec<Gcrs> true_position_m, true_velocity_m_per_s;  // geocentric, at mid exposure
  double true_range_m = 0.0;                         // at mid exposure, geometric
  double true_ra_rad = 0.0, true_dec_rad = 0.0;  // astrometric (geometric minus light time), mid
  double apparent_ra_rad = 0.0, apparent_dec_rad = 0.0;  // with the observer's aberration, mid
  double true_elevation_rad = 0.0;                       // 0 for a space sensor
  double phase_angle_rad = 0.0;                          // Sun-object-observer
  double sunlit = 0.0;  // fraction of the Sun's disc, mean over the exposure
  /// V above the atmosphere, when fully sunlit; with the light of Earth and Moon, if it is drawn.
  double true_magnitude = 0.0;
  // Light in the frame is that on pixels that collect it, not in a border of reference pixels.
  double rendered_signal_e = 0.0;                   // expected electrons deposited in the frame
  double rendered_x_px = 0.0, rendered_y_px = 0.0;  // centroid of its light in the frame; 0: none
  // Position of the object; may be outside the frame.
  double start_x_px = 0.0, start_y_px = 0.0, middle_x_px = 0.0, middle_y_px = 0.0;
  double end_x_px = 0.0, end_y_px = 0.0;
  bool in_frame = false;  // some of its light is in the frame
  bool whole = false;     // start, middle and end are inside
  bool resolved = false;  // drawn with its shape, not as a point
  /// Of the camera's axes from GCRS at mid exposure, where a sensor does not know them; none: they
  /// are as in the frame's header.
  std::optional<Quaternion> camera_from_gcrs;

  bool operator==(const Truth&) const = default;
};

}  // namespace dmise
