#include "core/exchange/udl.h"

#include <cmath>

#include "core/base/json.h"
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
  json.field("mag", d.magnitude).field("magUnc", d.magnitude_sigma);
  json.field("expDuration", frame.exposure_s()).field("trackId", d.id);
  json.field("descriptor", "mag in band " + d.band + "; SNR " + std::to_string(std::lround(d.snr)));
  json.end_object();
}

void write(const RunProducts& run, const Truth& t, JsonWriter& json) {
  const RunFrame& frame = run.frame(t.sensor, t.frame);
  begin(run, frame, t.middle, frame.sensor_position_m, frame.sensor_velocity_m_per_s, json);
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
