#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "core/base/sim_time.h"
#include "core/base/units.h"
#include "core/frames/quaternion.h"
#include "core/frames/vec.h"
#include "core/photometry/magnitude_system.h"
#include "core/products/product_fields.h"

namespace dmise {

/// True state of one object in one frame: `true_*` by the full physics, `rendered_*` as drawn.
/// Published on its own endpoint; only a scorer combines it with detections.
struct Truth {
  std::string sensor;
  std::uint32_t frame = 0;
  std::uint32_t catalogue_number = 0;
  std::string name;
  SimTime start, middle, end;                        // true times of the exposure
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
  /// Diameter of the disc on which its range puts a point's light, as it was drawn; 0: it is as
  /// sharp as stars.
  double defocus_disc_px = 0.0;
  /// Attitude of the camera at mid exposure, where a sensor does not know it; none: it is as in the
  /// frame's header.
  std::optional<Quaternion> camera_from_gcrs;

  bool operator==(const Truth&) const = default;
};

template <class V, MaybeConst<Truth> T>
void visit_fields(V& v, T& t) {
  v("sensor", t.sensor);
  v("frame", t.frame);
  v("catalogue_number", t.catalogue_number);
  v("name", t.name);
  v("start", t.start);
  v("middle", t.middle);
  v("end", t.end);
  v.absent_unless(true, "true_position_m", t.true_position_m, "true_position_gcrs_m");
  v.absent_unless(true, "true_velocity_m_per_s", t.true_velocity_m_per_s,
                  "true_velocity_gcrs_m_per_s");  // early versions wrote neither
  v("true_range_m", t.true_range_m);
  v("true_ra_rad", t.true_ra_rad, "true_ra_deg", deg);
  v("true_dec_rad", t.true_dec_rad, "true_dec_deg", deg);
  v("apparent_ra_rad", t.apparent_ra_rad, "apparent_ra_deg", deg);
  v("apparent_dec_rad", t.apparent_dec_rad, "apparent_dec_deg", deg);
  v("true_elevation_rad", t.true_elevation_rad, "true_elevation_deg", deg);
  v("phase_angle_rad", t.phase_angle_rad, "phase_angle_deg", deg);
  v("sunlit", t.sunlit);
  v("true_magnitude", t.true_magnitude);
  v.constant("magnitude_system", magnitude_system_name(MagnitudeSystem::v_solar));
  v("rendered_signal_e", t.rendered_signal_e);
  v.pair_or_null(t.rendered_signal_e > 0.0, "rendered_x_px", t.rendered_x_px, "rendered_y_px",
                 t.rendered_y_px, "rendered_px");
  v.pair("start_x_px", t.start_x_px, "start_y_px", t.start_y_px, "start_px");
  v.pair("middle_x_px", t.middle_x_px, "middle_y_px", t.middle_y_px, "middle_px");
  v.pair("end_x_px", t.end_x_px, "end_y_px", t.end_y_px, "end_px");
  v("in_frame", t.in_frame);
  v("whole", t.whole);
  v("resolved", t.resolved);
  v.absent_unless(t.defocus_disc_px > 0.0, "defocus_disc_px", t.defocus_disc_px);
  v("camera_from_gcrs", t.camera_from_gcrs);
}

}  // namespace dmise
