#pragma once
#include <array>
#include <string_view>

#include "core/frames/vec.h"
#include "nodes/wire/state_codec.h"

// One pair of functions per state: core type <-> message of proto/. Private to nodes/wire.
namespace dmise {

Encoded encode_body(const ObjectRoster&);
Encoded encode_body(const ObjectStates&);
Encoded encode_body(const EnvironmentState&);
Encoded encode_body(const SiteState&);
Encoded encode_body(const FrameReport&);
Encoded encode_body(const DetectionSet&);
Encoded encode_body(const TruthSet&);
Encoded encode_body(const TrackSet&);
Encoded encode_body(const TaskSet&);

ObjectRoster decode_roster(std::string_view payload, std::string_view arrays);
ObjectStates decode_states(std::string_view payload, std::string_view arrays);
EnvironmentState decode_environment(std::string_view payload);
SiteState decode_site(std::string_view payload);
FrameReport decode_report(std::string_view payload);
DetectionSet decode_detections(std::string_view payload);
TruthSet decode_truths(std::string_view payload);
TrackSet decode_tracks(std::string_view payload);
TaskSet decode_tasks(std::string_view payload);

/// What SGP4 takes of an element set, in the order of the array `elements` of a roster.
inline constexpr double MeanElements::*element_rows[] = {&MeanElements::epoch_jd1,
                                                         &MeanElements::epoch_jd2,
                                                         &MeanElements::mean_motion_rad_per_min,
                                                         &MeanElements::eccentricity,
                                                         &MeanElements::inclination_rad,
                                                         &MeanElements::raan_rad,
                                                         &MeanElements::argument_of_perigee_rad,
                                                         &MeanElements::mean_anomaly_rad,
                                                         &MeanElements::bstar_per_earth_radius};

/// Parses `payload` as a message of type `M`; throws `Refused`.
template <class M>
M parse(std::string_view payload) {
  M message;
  if (!message.ParseFromArray(payload.data(), static_cast<int>(payload.size())))
    throw Refused(Refusal::payload, "not a " + std::string(M::descriptor()->name()));
  return message;
}

template <class Repeated, std::size_t n>
void put(Repeated* field, const std::array<double, n>& values) {
  field->Add(values.begin(), values.end());
}

template <std::size_t n, class Repeated>
std::array<double, n> take(const Repeated& field, const char* name) {
  if (std::size_t(field.size()) != n)
    throw Refused(Refusal::payload, std::string(name) + ": must have " + std::to_string(n) +
                                        " values, got " + std::to_string(field.size()));
  std::array<double, n> values;
  std::copy(field.begin(), field.end(), values.begin());
  return values;
}

template <class Repeated, class F>
void put(Repeated* field, const Vec<F>& v) {
  put(field, std::array<double, 3>{v.x, v.y, v.z});
}

template <class F, class Repeated>
Vec<F> take_vec(const Repeated& field, const char* name) {
  const auto v = take<3>(field, name);
  return {v[0], v[1], v[2]};
}

}  // namespace dmise
