#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "core/base/sim_time.h"
#include "core/frames/vec.h"
#include "core/wcs/wcs.h"

namespace dmise {

enum class DetectionKind : std::uint8_t { point, streak };
/// Which instant of the exposure a time or direction belongs to.
enum class ExposureEpoch : std::uint8_t { start, middle, end };

/// One moving or point-like source found in one frame, from the counts image and its header alone.
/// Pixels: (0, 0) is the centre of the first pixel. Directions: RA/Dec in ICRS read through the
/// image's WCS ("astrometric": what the stars around it say), and the same put right for an object
/// that shares the Earth's motion and is near ("corrected").
struct Detection {
  std::string id;  // "<sensor>/<frame>/<index>", stable over runs
  std::string sensor;
  std::uint32_t frame = 0;  // counts from 1
  std::uint32_t index = 0;  // in the frame, from 0, by falling SNR
  DetectionKind kind = DetectionKind::point;
  ExposureEpoch epoch = ExposureEpoch::middle;
  SimTime time;  // of ra/dec
  // Astrometric, through the WCS, of the object at mid exposure: of a point its centroid, of a
  // streak the place on its line (core/detection/mid_exposure.h).
  double ra_rad = 0.0, dec_rad = 0.0;
  // Annual aberration put right, and the mean of the parallactic part of refraction.
  double corrected_ra_rad = 0.0, corrected_dec_rad = 0.0;
  // Of corrected_*: var(ra cos dec), cov, var(dec). It includes what one frame can't tell: along a
  // streak, where between the ends the object was at mid exposure (core/detection/mid_exposure.h);
  // along the vertical of a ground sensor, refraction_parallax_sigma_rad.
  std::array<double, 3> covariance_rad2{};
  Vec<Gcrs> sensor_position_m;  // at `time`
  Vec<Gcrs> sensor_velocity_m_per_s;
  bool light_time_removed = false;
  bool aberration_removed = false;  // of corrected_*
  // Nothing of refraction is left in corrected_*: in space, or where the frame was made without.
  // On the ground the WCS takes away the stars' share; what is left is smaller the farther the
  // object, and its range is not known.
  bool refraction_removed = false;
  // GCRS: outside the air the line of sight begins at sensor_position_m + this, square to it. An
  // object at range d stands norm / d higher than ra/dec say.
  Vec<Gcrs> refraction_offset_m;
  // Mean and standard deviation of that angle over altitudes from 300 km to GEO, evenly likely in
  // their logarithm: corrected_* are raised by the mean.
  double refraction_parallax_rad = 0.0, refraction_parallax_sigma_rad = 0.0;
  double magnitude = 0.0;  // in `band`, above the atmosphere, by the header's zero point
  double magnitude_sigma = 0.0;
  std::string band = "V";
  double snr = 0.0;               // signal_e / its standard error in the fit (a matched filter)
  double x_px = 0.0, y_px = 0.0;  // centroid of light
  std::array<double, 3> covariance_px2{};  // var x, cov xy, var y
  double signal_e = 0.0;                   // electrons above the background
  // Streak ends. Which end came first cannot be seen in one frame: end 1 is the one with smaller x
  // (y on a tie), times are those of a motion from end 1 to end 2 and `direction_known` is false.
  double end1_x_px = 0.0, end1_y_px = 0.0, end2_x_px = 0.0, end2_y_px = 0.0;
  double end1_ra_rad = 0.0, end1_dec_rad = 0.0, end2_ra_rad = 0.0, end2_dec_rad = 0.0;
  SimTime end1_time, end2_time;
  bool direction_known = false;
  // Errors of the ends as they were read through the WCS, of the fit, its model and the WCS.
  std::array<double, 3> end1_covariance_rad2{}, end2_covariance_rad2{};
  double length_px = 0.0;       // between the ends; 0 for a point
  double rate_rad_per_s = 0.0;  // angular, along the streak
  bool saturated = false;       // a pixel of it is at full well or at the ADC's limit
  bool at_edge = false;         // touches the frame's edge: an end is missing
  bool star_like = false;       // shape and direction are those that a star's trail has there

  bool operator==(const Detection&) const = default;
};

/// What is told of every exposure, also of one with nothing in it.
struct FrameReport {
  std::string sensor;
  std::uint32_t frame = 0;                                 // counts from 1
  SimTime start, middle, end;                              // of the exposure
  double boresight_ra_rad = 0.0, boresight_dec_rad = 0.0;  // ICRS, at mid exposure
  Wcs wcs;
  Vec<Gcrs> sensor_position_m, sensor_velocity_m_per_s;  // at mid exposure
  double limiting_magnitude = 0.0;  // of a point source at SNR = detection threshold
  double background_e = 0.0;        // median [e-/px]
  double noise_e = 0.0;             // median of the per-pixel noise [e-]
  double zero_point_mag = 0.0;      // magnitude of a source of 1 e-/s
  std::uint32_t detections = 0;     // published
  std::uint32_t star_like = 0;      // sources found that move as the stars do
  std::uint32_t saturated_px = 0;
  std::uint32_t stars_rendered = 0, objects_rendered = 0;
  std::string plan;  // "effect effect ..." that ran, in order
  // Nothing was looked for: limiting magnitude, background, noise, saturated_px and the numbers of
  // what was found are 0.
  bool detection_off = false;

  bool operator==(const FrameReport&) const = default;
};

}  // namespace dmise
