#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "core/base/sim_time.h"
#include "core/base/units.h"
#include "core/frames/vec.h"
#include "core/photometry/magnitude_system.h"
#include "core/products/light_curve.h"
#include "core/products/product_fields.h"

namespace dmise {

enum class DetectionKind : std::uint8_t { point, streak };
/// Instant of the exposure that a time or direction refers to.
enum class ExposureEpoch : std::uint8_t { start, middle, end };

inline constexpr std::array detection_kind_names{"point", "streak"};
inline constexpr std::array exposure_epoch_names{"start", "middle", "end"};
constexpr std::span<const char* const> names_of(DetectionKind) { return detection_kind_names; }
constexpr std::span<const char* const> names_of(ExposureEpoch) { return exposure_epoch_names; }

/// The magnitude of a detection without one.
inline constexpr double no_magnitude = 99.0;

/// One moving or point-like source detected in one frame, from the counts image and its header
/// alone. Pixels: (0, 0) is the centre of the first pixel. Directions: RA/Dec in ICRS from the
/// image's WCS ("astrometric": relative to the surrounding stars), and the same corrected for a
/// nearby object that shares the Earth's motion ("corrected").
struct Detection {
  std::string id;  // "<sensor>/<frame>/<index>", stable over runs
  std::string sensor;
  std::uint32_t frame = 0;  // from 1
  std::uint32_t index = 0;  // in the frame, from 0, by falling SNR
  DetectionKind kind = DetectionKind::point;
  ExposureEpoch epoch = ExposureEpoch::middle;
  SimTime time;  // when the object is at ra/dec
  // Astrometric, from the WCS, of the object at mid exposure: the centroid of a point, or the
  // position on a streak's line (core/detection/known/mid_exposure.h).
  double ra_rad = 0.0, dec_rad = 0.0;
  // Corrected for annual aberration and the mean of parallactic refraction.
  double corrected_ra_rad = 0.0, corrected_dec_rad = 0.0;
  // var(ra cos dec), cov, var(dec) of corrected_*, with what one frame cannot determine: along
  // a streak, the object's position at mid exposure (core/detection/known/mid_exposure.h); along
  // the vertical of a ground sensor, refraction_parallax_sigma_rad.
  std::array<double, 3> covariance_rad2{};
  Vec<Gcrs> sensor_position_m;  // at `time`
  Vec<Gcrs> sensor_velocity_m_per_s;
  bool light_time_removed = false;
  bool aberration_removed = false;  // from corrected_*
  // True if corrected_* contains no residual refraction: in space, or if the frame was made
  // without. On the ground the WCS removes the refraction of stars; the rest decreases with the
  // object's range, which is unknown.
  bool refraction_removed = false;
  // GCRS, perpendicular to the line of sight: above the atmosphere the line of sight starts at
  // sensor_position_m + this. An object at range d is norm / d higher than ra/dec.
  Vec<Gcrs> refraction_offset_m;
  // Mean and standard deviation of that angle over altitudes from 300 km to GEO, uniform in their
  // logarithm; corrected_* are raised by the mean.
  double refraction_parallax_rad = 0.0, refraction_parallax_sigma_rad = 0.0;
  // Only some sensors measure these: distance from the sensor to where the light or the echo left
  // the object, along corrected_*, and its derivative by the time of reception, with the motion of
  // the sensor. Each has a sigma.
  std::optional<double> range_m, range_sigma_m;
  std::optional<double> range_rate_m_per_s, range_rate_sigma_m_per_s;
  // Above the atmosphere, by the header's zero point; `no_magnitude` if its sensor measures none.
  double magnitude = 0.0;
  MagnitudeSystem magnitude_system = MagnitudeSystem::v_solar;
  double magnitude_sigma = 0.0;
  std::string band = "V";
  double snr = 0.0;               // signal_e / its standard error in the fit (a matched filter)
  double x_px = 0.0, y_px = 0.0;  // centroid of light
  std::array<double, 3> covariance_px2{};  // var x, cov xy, var y
  double signal_e = 0.0;                   // electrons above the background
  // Streak ends. One frame does not show which end came first: end 1 is the one with smaller x (y
  // on a tie), times assume a motion from end 1 to end 2 and `direction_known` is false.
  double end1_x_px = 0.0, end1_y_px = 0.0, end2_x_px = 0.0, end2_y_px = 0.0;
  double end1_ra_rad = 0.0, end1_dec_rad = 0.0, end2_ra_rad = 0.0, end2_dec_rad = 0.0;
  SimTime end1_time, end2_time;
  bool direction_known = false;
  // Errors of the ends as measured through the WCS: of the fit, its model and the WCS.
  std::array<double, 3> end1_covariance_rad2{}, end2_covariance_rad2{};
  double length_px = 0.0;       // between the ends; 0 for a point
  double rate_rad_per_s = 0.0;  // angular, along the streak
  // Direction of a streak on the sky at mid exposure, from end 1 to end 2: position angle from
  // north through east, [0, 2 pi); 0 for a point. Against the motion if it went from end 2 to
  // end 1.
  double position_angle_rad = 0.0;
  bool saturated = false;  // a pixel is at full well or at the ADC's limit
  bool at_edge = false;    // touches the frame's edge, or pixels without a value: an end is missing
  bool star_like = false;  // has the shape and direction of a star's trail
  bool excluded = false;   // Sun, Moon or limb was nearer to the axis than the camera allows
  // A streak has one where it was asked for and is long enough (core/detection/curve).
  std::optional<LightCurve> light_curve;

  bool operator==(const Detection&) const = default;
};

template <class V, MaybeConst<Detection> D>
void visit_fields(V& v, D& d) {
  v("id", d.id);
  v("sensor", d.sensor);
  v("frame", d.frame);
  v("index", d.index);
  v("kind", d.kind);
  v("epoch", d.epoch);
  v("time", d.time);
  v("ra_rad", d.ra_rad, "ra_deg", deg);
  v("dec_rad", d.dec_rad, "dec_deg", deg);
  v.constant("axes", "ICRS");
  v("corrected_ra_rad", d.corrected_ra_rad, "corrected_ra_deg", deg);
  v("corrected_dec_rad", d.corrected_dec_rad, "corrected_dec_deg", deg);
  v("covariance_rad2", d.covariance_rad2, "covariance_arcsec2", arcsec * arcsec);
  v("sensor_position_m", d.sensor_position_m, "sensor_position_gcrs_m");
  v("sensor_velocity_m_per_s", d.sensor_velocity_m_per_s, "sensor_velocity_gcrs_m_per_s");
  v("light_time_removed", d.light_time_removed);
  v("aberration_removed", d.aberration_removed);
  v("refraction_removed", d.refraction_removed);
  v("refraction_offset_m", d.refraction_offset_m, "refraction_offset_gcrs_m");
  v("refraction_parallax_rad", d.refraction_parallax_rad, "refraction_parallax_arcsec", arcsec);
  v("refraction_parallax_sigma_rad", d.refraction_parallax_sigma_rad,
    "refraction_parallax_sigma_arcsec", arcsec);
  v("magnitude", d.magnitude);
  v("magnitude_system", d.magnitude_system);
  v("magnitude_sigma", d.magnitude_sigma);
  v("band", d.band);
  v("snr", d.snr);
  v("x_px", d.x_px);
  v("y_px", d.y_px);
  v("covariance_px2", d.covariance_px2);
  v("signal_e", d.signal_e);
  v.pair("end1_x_px", d.end1_x_px, "end1_y_px", d.end1_y_px, "end1_px");
  v.pair("end2_x_px", d.end2_x_px, "end2_y_px", d.end2_y_px, "end2_px");
  v("end1_ra_rad", d.end1_ra_rad, "end1_ra_deg", deg);
  v("end1_dec_rad", d.end1_dec_rad, "end1_dec_deg", deg);
  v("end2_ra_rad", d.end2_ra_rad, "end2_ra_deg", deg);
  v("end2_dec_rad", d.end2_dec_rad, "end2_dec_deg", deg);
  v("end1_covariance_rad2", d.end1_covariance_rad2, "end1_covariance_arcsec2", arcsec * arcsec);
  v("end2_covariance_rad2", d.end2_covariance_rad2, "end2_covariance_arcsec2", arcsec * arcsec);
  v("end1_time", d.end1_time);
  v("end2_time", d.end2_time);
  v("direction_known", d.direction_known);
  v("length_px", d.length_px);
  v("rate_rad_per_s", d.rate_rad_per_s, "rate_arcsec_per_s", arcsec);
  v("position_angle_rad", d.position_angle_rad, "position_angle_deg", deg);
  v("saturated", d.saturated);
  v("at_edge", d.at_edge);
  v("star_like", d.star_like);
  v.absent_unless(d.excluded, "excluded", d.excluded);
  v("range_m", d.range_m);
  v("range_sigma_m", d.range_sigma_m);
  v("range_rate_m_per_s", d.range_rate_m_per_s);
  v("range_rate_sigma_m_per_s", d.range_rate_sigma_m_per_s);
  v("light_curve", d.light_curve);
}

}  // namespace dmise
