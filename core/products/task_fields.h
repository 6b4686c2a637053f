#pragma once
#include "core/base/units.h"
#include "core/products/task.h"

// The table of a task's fields, in the order of a JSON line: the wire's codec and the JSON line are
// made from it. Its rows are those of core/products/detection_fields.h, and
//   NUMBERS(field, key)         a list of numbers of any length
// To add one: the member, its row here, and its field in proto/dmise/v1/task.proto.
// clang-format off
#define DMISE_TASK_FIELDS(VALUE, TIME, LIST, NUMBERS)                           \
  VALUE(id, "id", 1)                                                            \
  VALUE(sensor, "sensor", 1)                                                    \
  VALUE(track, "track", 1)                                                      \
  VALUE(catalogue_number, "catalogue_number", 1)                                \
  VALUE(name, "name", 1)                                                        \
  TIME(given, "given")                                                          \
  TIME(start, "start")                                                          \
  TIME(on_target, "on_target")                                                  \
  TIME(end, "end")                                                              \
  VALUE(first_frame, "first_frame", 1)                                          \
  VALUE(exposures, "exposures", 1)                                              \
  VALUE(gain_nats, "gain_nats", 1)                                              \
  VALUE(gain_nats_per_s, "gain_nats_per_s", 1)                                  \
  VALUE(candidates, "candidates", 1)                                            \
  VALUE(runner_up, "runner_up", 1)                                              \
  VALUE(runner_up_nats_per_s, "runner_up_nats_per_s", 1)                        \
  VALUE(in_field, "in_field", 1)                                                \
  VALUE(detection_probability, "detection_probability", 1)                      \
  VALUE(sigma_rad, "sigma_arcsec", arcsec)                                      \
  VALUE(slew_rad, "slew_deg", deg)                                              \
  VALUE(slew_s, "slew_s", 1)                                                    \
  LIST(covariance, "covariance_gcrs", 21)                                       \
  TIME(path_start, "path_start")                                                \
  VALUE(path_step_s, "path_step_s", 1)                                          \
  NUMBERS(path_m, "path_gcrs_m")                                                \
  NUMBERS(path_m_per_s, "path_gcrs_m_per_s")
// clang-format on
