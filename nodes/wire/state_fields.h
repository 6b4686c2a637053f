#pragma once
#include "core/products/product_fields.h"
#include "core/sim/message.h"

// The fields of states and of sets of products as messages have them (`visit_fields`,
// core/products/product_fields.h). Private to nodes/wire.
namespace dmise {

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

}  // namespace dmise
