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

}  // namespace

Encoded encode_body(const EnvironmentState& state) {
  v1::EnvironmentState message;
  message.set_tick(state.tick);
  message.set_time_ns(state.time.ns);
  auto* earth = message.mutable_earth();
  earth->set_time_ns(state.earth.time.ns);
  put_rotation(earth->mutable_cirs_from_gcrs(), state.earth.cirs_from_gcrs);
  put_rotation(earth->mutable_itrs_from_tirs(), state.earth.itrs_from_tirs);
  earth->set_era_rad(state.earth.era_rad);
  earth->set_era_rate_rad_per_s(state.earth.era_rate_rad_per_s);
  earth->set_gmst82_rad(state.earth.gmst82_rad);
  earth->set_gmst82_rate_rad_per_s(state.earth.gmst82_rate_rad_per_s);
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
  const auto& earth = message.earth();
  EnvironmentState state;
  state.tick = message.tick();
  state.time = {message.time_ns()};
  state.earth.time = {earth.time_ns()};
  state.earth.cirs_from_gcrs =
      take_rotation<Cirs, Gcrs>(earth.cirs_from_gcrs(), "earth.cirs_from_gcrs");
  state.earth.itrs_from_tirs =
      take_rotation<Itrs, Tirs>(earth.itrs_from_tirs(), "earth.itrs_from_tirs");
  state.earth.era_rad = earth.era_rad();
  state.earth.era_rate_rad_per_s = earth.era_rate_rad_per_s();
  state.earth.gmst82_rad = earth.gmst82_rad();
  state.earth.gmst82_rate_rad_per_s = earth.gmst82_rate_rad_per_s();
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
