#include "dmise/v1/environment.pb.h"
#include "nodes/wire/codecs.h"

namespace dmise {
namespace {

template <class To, class From, class Repeated>
void put_rotation(Repeated* field, const Rotation<To, From>& r) {
  for (const auto& row : r.m) field->Add(row.begin(), row.end());
}

template <class To, class From, class Repeated>
Rotation<To, From> take_rotation(const Repeated& field, const char* name) {
  const auto values = take<9>(field, name);
  Rotation<To, From> r;
  for (std::size_t i = 0; i < 9; ++i) r.m[i / 3][i % 3] = values[i];
  return r;
}

void put_orientation(v1::EarthOrientation* message, const EarthOrientation& earth) {
  message->set_time_ns(earth.time.ns);
  put_rotation(message->mutable_cirs_from_gcrs(), earth.cirs_from_gcrs);
  put_rotation(message->mutable_itrs_from_tirs(), earth.itrs_from_tirs);
  message->set_era_rad(earth.era_rad);
  message->set_era_rate_rad_per_s(earth.era_rate_rad_per_s);
  message->set_gmst82_rad(earth.gmst82_rad);
  message->set_gmst82_rate_rad_per_s(earth.gmst82_rate_rad_per_s);
}

EarthOrientation take_earth(const v1::EarthOrientation& message) {
  return {
      .time = {message.time_ns()},
      .cirs_from_gcrs = take_rotation<Cirs, Gcrs>(message.cirs_from_gcrs(), "earth.cirs_from_gcrs"),
      .itrs_from_tirs = take_rotation<Itrs, Tirs>(message.itrs_from_tirs(), "earth.itrs_from_tirs"),
      .era_rad = message.era_rad(),
      .era_rate_rad_per_s = message.era_rate_rad_per_s(),
      .gmst82_rad = message.gmst82_rad(),
      .gmst82_rate_rad_per_s = message.gmst82_rate_rad_per_s()};
}

}  // namespace

Encoded encode_body(const EnvironmentState& state) {
  v1::EnvironmentState message;
  message.set_tick(state.tick);
  message.set_time_ns(state.time.ns);
  put_orientation(message.mutable_earth(), state.earth);
  if (state.earth_beside)
    for (const EarthOrientation& earth : *state.earth_beside)
      put_orientation(message.add_earth_beside(), earth);
  put(message.mutable_sun_m(), state.sun_m);
  put(message.mutable_moon_m(), state.moon_m);
  put(message.mutable_earth_barycentric_m(), state.earth_barycentric_m);
  put(message.mutable_earth_velocity_m_per_s(), state.earth_velocity_m_per_s);
  put(message.mutable_moon_velocity_m_per_s(), state.moon_velocity_m_per_s);
  message.set_tt_jd1_days(state.tt_jd1);
  message.set_tt_jd2_days(state.tt_jd2);
  return {MessageKind::environment_state, message.SerializeAsString(), {}};
}

EnvironmentState decode_environment(std::string_view payload) {
  const auto message = parse<v1::EnvironmentState>(payload);
  EnvironmentState state;
  state.tick = message.tick();
  state.time = {message.time_ns()};
  state.earth = take_earth(message.earth());
  if (const auto& beside = message.earth_beside(); !beside.empty()) {
    if (beside.size() != 2)
      throw Refused(Refusal::payload,
                    "earth_beside: must have 2 orientations, got " + std::to_string(beside.size()));
    state.earth_beside = {take_earth(beside[0]), take_earth(beside[1])};
  }
  state.sun_m = take_vec<Gcrs>(message.sun_m(), "sun_m");
  state.moon_m = take_vec<Gcrs>(message.moon_m(), "moon_m");
  state.earth_barycentric_m = take_vec<Gcrs>(message.earth_barycentric_m(), "earth_barycentric_m");
  state.earth_velocity_m_per_s =
      take_vec<Gcrs>(message.earth_velocity_m_per_s(), "earth_velocity_m_per_s");
  state.moon_velocity_m_per_s =
      take_vec<Gcrs>(message.moon_velocity_m_per_s(), "moon_velocity_m_per_s");
  state.tt_jd1 = message.tt_jd1_days();
  state.tt_jd2 = message.tt_jd2_days();
  return state;
}

Encoded encode_body(const SiteState& state) {
  v1::SiteState message;
  message.set_tick(state.tick);
  message.set_time_ns(state.time.ns);
  message.set_sensor(state.sensor);
  message.set_extinction_mag_per_airmass(state.extinction_mag_per_airmass);
  message.set_pressure_hpa(state.pressure_hpa);
  message.set_temperature_c(state.temperature_c);
  message.set_humidity(state.humidity);
  message.set_cloud_transmission(state.cloud_transmission);
  message.set_r0_m(state.r0_m);
  message.set_isoplanatic_angle_rad(state.isoplanatic_angle_rad);
  message.set_tau0_s(state.tau0_s);
  message.set_turbulence_m_per_s(state.turbulence_m_per_s);
  return {MessageKind::site_state, message.SerializeAsString(), {}};
}

SiteState decode_site(std::string_view payload) {
  const auto message = parse<v1::SiteState>(payload);
  return {.tick = message.tick(),
          .time = {message.time_ns()},
          .sensor = message.sensor(),
          .extinction_mag_per_airmass = message.extinction_mag_per_airmass(),
          .pressure_hpa = message.pressure_hpa(),
          .temperature_c = message.temperature_c(),
          .humidity = message.humidity(),
          .cloud_transmission = message.cloud_transmission(),
          .r0_m = message.r0_m(),
          .isoplanatic_angle_rad = message.isoplanatic_angle_rad(),
          .tau0_s = message.tau0_s(),
          .turbulence_m_per_s = message.turbulence_m_per_s()};
}

}  // namespace dmise
