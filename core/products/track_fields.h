#pragma once
#include "core/products/track.h"

// The table of a track's fields, in the order of a JSON line: the wire's codec and the JSON line
// are made from it. Its rows are those of core/products/detection_fields.h, and
//   TEXTS(field, key)           an array of texts
// To add one: the member, its row here, and its field in proto/dmise/v1/track.proto.
// clang-format off
#define DMISE_TRACK_FIELDS(VALUE, TIME, NAME, LIST, VECTOR, TEXTS)              \
  VALUE(id, "id")                                                               \
  NAME(status, "status", TrackStatus)                                           \
  TIME(time, "time")                                                            \
  VECTOR(position_m, "position_gcrs_m")                                         \
  VECTOR(velocity_m_per_s, "velocity_gcrs_m_per_s")                             \
  LIST(covariance, "covariance_gcrs", 21)                                       \
  VALUE(drag_m2_per_kg, "drag_m2_per_kg")                                       \
  VALUE(drag_sigma_m2_per_kg, "drag_sigma_m2_per_kg")                           \
  VALUE(srp_m2_per_kg, "srp_m2_per_kg")                                         \
  VALUE(srp_sigma_m2_per_kg, "srp_sigma_m2_per_kg")                             \
  VALUE(catalogue_number, "catalogue_number")                                   \
  VALUE(name, "name")                                                           \
  VALUE(existence, "existence")                                                 \
  VALUE(detections, "detections")                                               \
  TEXTS(associated, "associated")                                               \
  VALUE(innovation_d2, "innovation_d2")                                         \
  TIME(last_seen, "last_seen")                                                  \
  VALUE(magnitude, "magnitude")
// clang-format on
