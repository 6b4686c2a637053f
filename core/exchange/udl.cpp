#include "core/exchange/udl.h"

#include <cmath>

#include "core/base/files/json.h"
#include "core/base/units.h"
#include "core/exchange/export_format.h"
#include "core/time/iso8601.h"

namespace dmise {
namespace {

/// The fields that all records share.
void begin(const RunProducts& run, const RunFrame& frame, SimTime time, const Vec<Gcrs>& position_m,
           const Vec<Gcrs>& velocity_m_per_s, JsonWriter& json) {
  json.begin_object().field("classificationMarking", "U").field("dataMode", "SIMULATED");
  json.field("source", "DMISE").field("obTime", format_utc(run.clock.utc(time), 6));
  json.field("idSensor", frame.sensor).field("origSensorId", frame.sensor);
  json.field("referenceFrame", "GCRF").field("senReferenceFrame", "GCRF");
  const Vec<Gcrs>& p = position_m;
  const Vec<Gcrs>& v = velocity_m_per_s;
  json.field("senx", p.x / km).field("seny", p.y / km).field("senz", p.z / km);
  json.field("senvelx", v.x / km).field("senvely", v.y / km).field("senvelz", v.z / km);
  if (const auto& site = run.sensor(frame.sensor).site) {
    json.field("senlat", site->latitude_deg).field("senlon", site->longitude_deg);
    json.field("senalt", site->height_m / km);
  }
}

void angles(double ra_rad, double dec_rad, bool measured, JsonWriter& json) {
  json.field("ra", std::fmod(ra_rad / deg + 360.0, 360.0)).field("declination", dec_rad / deg);
  json.field("raMeasured", measured).field("declinationMeasured", measured);
}

void write(const RunProducts& run, const Detection& d, JsonWriter& json) {
  const RunFrame& frame = run.frame(d.sensor, d.frame);
  begin(run, frame, d.time, d.sensor_position_m, d.sensor_velocity_m_per_s, json);
  angles(d.corrected_ra_rad, d.corrected_dec_rad, true, json);
  const double cos_dec = std::cos(d.corrected_dec_rad);
  // At a pole right ascension is not determined.
  if (cos_dec > 1e-9) json.field("raUnc", std::sqrt(d.covariance_rad2[0]) / cos_dec / deg);
  json.field("declinationUnc", std::sqrt(d.covariance_rad2[2]) / deg);
  if (d.kind == DetectionKind::streak && d.direction_known && cos_dec > 1e-9) {
    const double rate_deg = d.rate_rad_per_s / deg;
    json.field("raRate", rate_deg * std::sin(d.position_angle_rad) / cos_dec);
    json.field("declinationRate", rate_deg * std::cos(d.position_angle_rad));
  }
  if (d.magnitude != no_magnitude)
    json.field("mag", d.magnitude).field("magUnc", d.magnitude_sigma);
  json.field("expDuration", frame.exposure_s()).field("trackId", d.id);
  json.field("descriptor", "mag in band " + d.band + "; SNR " + std::to_string(std::lround(d.snr)));
  json.end_object();
}

struct SensorState {
  Vec<Gcrs> position_m, velocity_m_per_s;
};

/// Returns the sensor at the true middle of an exposure. A frame reports it at the middle by the
/// sensor's clock, for all rows at once; if an object's is another, its truth is followed
/// backwards: its light came from where it was a light time before, on a straight path, as truth
/// has it.
SensorState true_state(const RunProducts& run, const RunFrame& frame, const Truth& t) {
  const double late_s = (t.middle - frame.middle).seconds();
  if (late_s == 0.0) return {frame.sensor_position_m, frame.sensor_velocity_m_per_s};
  require_states(run, t);
  Vec<Gcrs> line = from_spherical<Gcrs>(t.true_ra_rad, t.true_dec_rad);
  if (run.sensor(t.sensor).light_time)
    line += t.true_velocity_m_per_s * (1.0 / speed_of_light_m_per_s);
  const Vec<Gcrs> position_m = t.true_position_m - unit(line) * t.true_range_m;
  // The acceleration between the two times is taken as constant. Within a millisecond a sensor in
  // orbit gains less than 0.01 m/s, and the difference of the positions says no more.
  constexpr double shortest_s = 1e-3;
  if (std::abs(late_s) < shortest_s) return {position_m, frame.sensor_velocity_m_per_s};
  return {position_m,
          (position_m - frame.sensor_position_m) * (2.0 / late_s) - frame.sensor_velocity_m_per_s};
}

void write(const RunProducts& run, const Truth& t, JsonWriter& json) {
  const RunFrame& frame = run.frame(t.sensor, t.frame);
  const SensorState sensor = true_state(run, frame, t);
  begin(run, frame, t.middle, sensor.position_m, sensor.velocity_m_per_s, json);
  angles(t.true_ra_rad, t.true_dec_rad, false, json);
  json.field("range", t.true_range_m / km).field("rangeMeasured", false);
  if (run.sensor(t.sensor).site) json.field("elevation", t.true_elevation_rad / deg);
  json.field("solarPhaseAngle", t.phase_angle_rad / deg);
  json.field("umbra", t.sunlit <= 0.0).field("penumbra", t.sunlit > 0.0 && t.sunlit < 1.0);
  if (t.sunlit > 0.0) json.field("mag", t.true_magnitude - 2.5 * std::log10(t.sunlit));
  json.field("expDuration", (t.end - t.start).seconds());
  json.field("origObjectId", t.name).field("uct", false);
  if (t.catalogue_number > 0) json.field("satNo", t.catalogue_number);
  json.field("descriptor", "truth; mag in band V").end_object();
}

}  // namespace

std::string udl_json(const ExportRequest& request) {
  JsonWriter json;
  json.begin_array();
  for (const Detection& d : request.run.detections) write(request.run, d, json);
  for (const Truth& t : request.run.truths)
    if (t.in_frame) write(request.run, t, json);
  return json.end_array().take() + "\n";
}

}  // namespace dmise
