#include "core/products/product_fields.h"
#include "core/sim/message.h"
#include "dmise/v1/detection.pb.h"
#include "dmise/v1/environment.pb.h"
#include "dmise/v1/frame.pb.h"
#include "dmise/v1/task.pb.h"
#include "dmise/v1/track.pb.h"
#include "nodes/wire/codecs.h"
#include "nodes/wire/product_message.h"

namespace dmise {

// The fields of states and of sets of products as messages have them (`visit_fields`,
// core/products/product_fields.h).

template <class V, MaybeConst<EarthOrientation> E>
void visit_fields(V& v, E& earth) {
  v("time", earth.time);
  v("cirs_from_gcrs", earth.cirs_from_gcrs);
  v("itrs_from_tirs", earth.itrs_from_tirs);
  v("era_rad", earth.era_rad);
  v("era_rate_rad_per_s", earth.era_rate_rad_per_s);
  v("gmst82_rad", earth.gmst82_rad);
  v("gmst82_rate_rad_per_s", earth.gmst82_rate_rad_per_s);
}

template <class V, MaybeConst<EnvironmentState> S>
void visit_fields(V& v, S& state) {
  v("tick", state.tick);
  v("time", state.time);
  v("earth", state.earth);
  v("earth_beside", state.earth_beside);
  v("sun_m", state.sun_m);
  v("moon_m", state.moon_m);
  v("earth_barycentric_m", state.earth_barycentric_m);
  v("earth_velocity_m_per_s", state.earth_velocity_m_per_s);
  v("moon_velocity_m_per_s", state.moon_velocity_m_per_s);
  v("tt_jd1_days", state.tt_jd1);
  v("tt_jd2_days", state.tt_jd2);
}

template <class V, MaybeConst<SiteState> S>
void visit_fields(V& v, S& state) {
  v("tick", state.tick);
  v("time", state.time);
  v("sensor", state.sensor);
  v("extinction_mag_per_airmass", state.extinction_mag_per_airmass);
  v("pressure_hpa", state.pressure_hpa);
  v("temperature_c", state.temperature_c);
  v("humidity", state.humidity);
  v("cloud_transmission", state.cloud_transmission);
  v("r0_m", state.r0_m);
  v("isoplanatic_angle_rad", state.isoplanatic_angle_rad);
  v("tau0_s", state.tau0_s);
  v("turbulence_m_per_s", state.turbulence_m_per_s);
}

template <class V, MaybeConst<DetectionSet> S>
void visit_fields(V& v, S& set) {
  v("sensor", set.sensor);
  v("frame", set.frame);
  v("detections", set.detections);
}

template <class V, MaybeConst<TruthSet> S>
void visit_fields(V& v, S& set) {
  v("sensor", set.sensor);
  v("frame", set.frame);
  v("truths", set.truths);
}

template <class V, MaybeConst<TrackSet> S>
void visit_fields(V& v, S& set) {
  v("node", set.node);
  v("tick", set.tick);
  v("time", set.time);
  v("live", set.live);
  v("unassociated", set.unassociated);
  v("tracks", set.tracks);
}

template <class V, MaybeConst<TaskSet> S>
void visit_fields(V& v, S& set) {
  v("node", set.node);
  v("sensor", set.sensor);
  v("tick", set.tick);
  v("time", set.time);
  v("tasks", set.tasks);
}

namespace {

template <class M, class State>
Encoded encoded(MessageKind kind, const State& state) {
  M message;
  put_product(message, state);
  return {kind, message.SerializeAsString(), {}};
}

}  // namespace

Encoded encode_body(const EnvironmentState& s) {
  return encoded<v1::EnvironmentState>(MessageKind::environment_state, s);
}
EnvironmentState decode_environment(std::string_view payload) {
  return take_product<EnvironmentState>(parse<v1::EnvironmentState>(payload));
}

Encoded encode_body(const SiteState& s) {
  return encoded<v1::SiteState>(MessageKind::site_state, s);
}
SiteState decode_site(std::string_view payload) {
  return take_product<SiteState>(parse<v1::SiteState>(payload));
}

Encoded encode_body(const FrameReport& s) {
  return encoded<v1::FrameReport>(MessageKind::frame_report, s);
}
FrameReport decode_report(std::string_view payload) {
  return take_product<FrameReport>(parse<v1::FrameReport>(payload));
}

Encoded encode_body(const DetectionSet& s) {
  return encoded<v1::DetectionSet>(MessageKind::detection_set, s);
}
DetectionSet decode_detections(std::string_view payload) {
  return take_product<DetectionSet>(parse<v1::DetectionSet>(payload));
}

Encoded encode_body(const TruthSet& s) { return encoded<v1::TruthSet>(MessageKind::truth_set, s); }
TruthSet decode_truths(std::string_view payload) {
  return take_product<TruthSet>(parse<v1::TruthSet>(payload));
}

Encoded encode_body(const TrackSet& s) { return encoded<v1::TrackSet>(MessageKind::track_set, s); }
TrackSet decode_tracks(std::string_view payload) {
  return take_product<TrackSet>(parse<v1::TrackSet>(payload));
}

Encoded encode_body(const TaskSet& s) { return encoded<v1::TaskSet>(MessageKind::task_set, s); }
TaskSet decode_tasks(std::string_view payload) {
  return take_product<TaskSet>(parse<v1::TaskSet>(payload));
}

}  // namespace dmise
