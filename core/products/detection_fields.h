#pragma once
#include "core/base/units.h"
#include "core/products/detection.h"

// The table of a detection's fields, in the order of a JSON line: the wire's codec and the JSON
// line are made from it. Its rows are
//   VALUE(field, key, unit)     a number in `unit` in JSON, a flag or a text (unit 1)
//   TIME(field, key)            KEY_ns and KEY_utc in JSON, FIELD_ns on the wire
//   NAME(field, key, Enum)      an enumeration: its name in JSON, a number on the wire
//   LIST(field, key, unit)      an array of numbers
//   VECTOR(field, key)          a vector in GCRS
//   PAIR(x, y, key)             two numbers, an array in JSON
//   TEXT(key, value)            a constant, only in JSON
//   WHERE(field, key)           a flag that is in JSON only where it is set
//   MEASURED(field, key)        a number that few sensors measure: absent in JSON and on the wire
//                               where it is empty
// A field on the wire has the name of the member. To add one: the member, its row here, and its
// field in proto/dmise/v1/detection.proto; core/detection/describe.cpp computes it.
// clang-format off
#define DMISE_DETECTION_FIELDS(VALUE, TIME, NAME, LIST, VECTOR, PAIR, TEXT, WHERE, MEASURED) \
  VALUE(id, "id", 1)                                                                    \
  VALUE(sensor, "sensor", 1)                                                            \
  VALUE(frame, "frame", 1)                                                              \
  VALUE(index, "index", 1)                                                              \
  NAME(kind, "kind", DetectionKind)                                                     \
  NAME(epoch, "epoch", ExposureEpoch)                                                   \
  TIME(time, "time")                                                                    \
  VALUE(ra_rad, "ra_deg", deg)                                                          \
  VALUE(dec_rad, "dec_deg", deg)                                                        \
  TEXT("axes", "ICRS")                                                                  \
  VALUE(corrected_ra_rad, "corrected_ra_deg", deg)                                      \
  VALUE(corrected_dec_rad, "corrected_dec_deg", deg)                                    \
  LIST(covariance_rad2, "covariance_arcsec2", arcsec * arcsec)                          \
  VECTOR(sensor_position_m, "sensor_position_gcrs_m")                                   \
  VECTOR(sensor_velocity_m_per_s, "sensor_velocity_gcrs_m_per_s")                       \
  VALUE(light_time_removed, "light_time_removed", 1)                                    \
  VALUE(aberration_removed, "aberration_removed", 1)                                    \
  VALUE(refraction_removed, "refraction_removed", 1)                                    \
  VECTOR(refraction_offset_m, "refraction_offset_gcrs_m")                               \
  VALUE(refraction_parallax_rad, "refraction_parallax_arcsec", arcsec)                  \
  VALUE(refraction_parallax_sigma_rad, "refraction_parallax_sigma_arcsec", arcsec)      \
  VALUE(magnitude, "magnitude", 1)                                                      \
  NAME(magnitude_system, "magnitude_system", MagnitudeSystem)                           \
  VALUE(magnitude_sigma, "magnitude_sigma", 1)                                          \
  VALUE(band, "band", 1)                                                                \
  VALUE(snr, "snr", 1)                                                                  \
  VALUE(x_px, "x_px", 1)                                                                \
  VALUE(y_px, "y_px", 1)                                                                \
  LIST(covariance_px2, "covariance_px2", 1)                                             \
  VALUE(signal_e, "signal_e", 1)                                                        \
  PAIR(end1_x_px, end1_y_px, "end1_px")                                                 \
  PAIR(end2_x_px, end2_y_px, "end2_px")                                                 \
  VALUE(end1_ra_rad, "end1_ra_deg", deg)                                                \
  VALUE(end1_dec_rad, "end1_dec_deg", deg)                                              \
  VALUE(end2_ra_rad, "end2_ra_deg", deg)                                                \
  VALUE(end2_dec_rad, "end2_dec_deg", deg)                                              \
  LIST(end1_covariance_rad2, "end1_covariance_arcsec2", arcsec * arcsec)                \
  LIST(end2_covariance_rad2, "end2_covariance_arcsec2", arcsec * arcsec)                \
  TIME(end1_time, "end1_time")                                                          \
  TIME(end2_time, "end2_time")                                                          \
  VALUE(direction_known, "direction_known", 1)                                          \
  VALUE(length_px, "length_px", 1)                                                      \
  VALUE(rate_rad_per_s, "rate_arcsec_per_s", arcsec)                                    \
  VALUE(position_angle_rad, "position_angle_deg", deg)                                   \
  VALUE(saturated, "saturated", 1)                                                      \
  VALUE(at_edge, "at_edge", 1)                                                          \
  VALUE(star_like, "star_like", 1)                                                      \
  WHERE(excluded, "excluded")                                                           \
  MEASURED(range_m, "range_m")                                                          \
  MEASURED(range_sigma_m, "range_sigma_m")                                              \
  MEASURED(range_rate_m_per_s, "range_rate_m_per_s")                                    \
  MEASURED(range_rate_sigma_m_per_s, "range_rate_sigma_m_per_s")
// clang-format on
