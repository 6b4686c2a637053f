#include "core/exchange/tdm.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "core/base/formatted.h"
#include "core/base/units.h"
#include "core/exchange/export_format.h"
#include "core/exchange/kvn_text.h"
#include "core/exchange/number_text.h"

namespace dmise {
namespace {

constexpr int angle_decimals = 9;  // in degrees: 4 microarcsec

/// One observation of a segment.
struct Seen {
  SimTime time;
  double ra_rad = 0.0, dec_rad = 0.0;
  double magnitude = 0.0;  // no_magnitude: none
  std::optional<double> range_m, range_rate_m_per_s;
};

struct Segment {
  std::string sensor, object, track;
  double exposure_s = 0.0;
  const char* quality = nullptr;  // nobody has looked at what a sensor found: RAW
  std::vector<std::string> comments;
  std::vector<std::pair<const char*, std::string>> corrections;
  std::vector<Seen> sightings;
};

std::string place_comment(const RunSensor& sensor) {
  if (!sensor.site) return "sensor " + sensor.name + " is on board of " + sensor.platform;
  return "sensor " + sensor.name + ": geodetic latitude " +
         fixed_text(sensor.site->latitude_deg, angle_decimals) + " deg, longitude " +
         fixed_text(sensor.site->longitude_deg, angle_decimals) + " deg, height " +
         fixed_text(sensor.site->height_m, 3) + " m";
}

std::string vector_comment(const char* what, const Vec<Gcrs>& v, const char* unit) {
  return std::string(what) + " in GCRS at the time tag: " + fixed_text(v.x / km, 9) + " " +
         fixed_text(v.y / km, 9) + " " + fixed_text(v.z / km, 9) + " " + unit;
}

/// What all sightings of a segment have.
std::string data_types(const Seen& seen) {
  return std::string("ANGLE_1,ANGLE_2") + (seen.range_m ? ",RANGE" : "") +
         (seen.range_rate_m_per_s ? ",DOPPLER_INSTANTANEOUS" : "") +
         (seen.magnitude != no_magnitude ? ",MAG" : "");
}

void write(const RunProducts& run, const Segment& s, KvnText& kvn) {
  kvn.line("META_START");
  for (const std::string& comment : s.comments) kvn.comment(comment);
  kvn.key("TRACK_ID", s.track).key("DATA_TYPES", data_types(s.sightings.front()));
  kvn.key("TIME_SYSTEM", "UTC");
  kvn.key("START_TIME", run.utc(s.sightings.front().time));
  kvn.key("STOP_TIME", run.utc(s.sightings.back().time));
  kvn.key("PARTICIPANT_1", s.sensor).key("PARTICIPANT_2", s.object);
  kvn.key("MODE", "SEQUENTIAL").key("PATH", "2,1").key("TIMETAG_REF", "RECEIVE");
  kvn.key("INTEGRATION_INTERVAL", shortest_text(s.exposure_s)).key("INTEGRATION_REF", "MIDDLE");
  kvn.key("ANGLE_TYPE", "RADEC").key("REFERENCE_FRAME", "ICRF").key("DATA_QUALITY", s.quality);
  for (const auto& [key, value] : s.corrections) kvn.key(key, value);
  kvn.key("CORRECTIONS_APPLIED", "YES").line("META_STOP").line("DATA_START");
  for (const Seen& sighting : s.sightings) {
    const std::string time = run.utc(sighting.time) + " ";
    double ra_deg = std::fmod(sighting.ra_rad / deg + 360.0, 360.0);
    if (ra_deg > 360.0 - 0.5e-9) ra_deg = 0.0;  // it would be rounded to 360, which is out of range
    kvn.key("ANGLE_1", time + fixed_text(ra_deg, angle_decimals));
    kvn.key("ANGLE_2", time + fixed_text(sighting.dec_rad / deg, angle_decimals));
    if (const auto& range_m = sighting.range_m)
      kvn.key("RANGE", time + fixed_text(*range_m / km, 9));
    if (const auto& rate_m_per_s = sighting.range_rate_m_per_s)
      kvn.key("DOPPLER_INSTANTANEOUS", time + fixed_text(*rate_m_per_s / km, 12));
    if (sighting.magnitude != no_magnitude)
      kvn.key("MAG", time + fixed_text(sighting.magnitude, 6));
  }
  kvn.line("DATA_STOP");
}

/// `a` - `b` of two right ascensions [rad, -pi..pi].
double angle_between_rad(double a, double b) { return std::remainder(a - b, 2.0 * pi); }

Segment segment_of(const RunProducts& run, const Detection& d) {
  const double sigma_ra = std::sqrt(d.covariance_rad2[0]),
               sigma_dec = std::sqrt(d.covariance_rad2[2]);
  const double both = sigma_ra * sigma_dec;
  Segment s{.sensor = d.sensor,
            .object = "UNKNOWN",
            .track = d.id,
            .exposure_s = run.frame(d.sensor, d.frame).exposure_s(),
            .quality = "RAW"};
  s.comments = {place_comment(run.sensor(d.sensor)),
                vector_comment("position of the sensor", d.sensor_position_m, "km"),
                vector_comment("velocity of the sensor", d.sensor_velocity_m_per_s, "km/s"),
                "angles are measured against the stars and " +
                    std::string(d.aberration_removed ? "corrected" : "not corrected") +
                    " for annual aberration; light time is " +
                    (d.light_time_removed ? "" : "not ") +
                    "removed: they are of the object when the light left it",
                "refraction is that of the stars" +
                    std::string(d.refraction_removed
                                    ? ""
                                    : "; angles are raised by its parallax of an unknown range, " +
                                          fixed_text(d.refraction_parallax_rad / arcsec, 6) +
                                          " arcsec, sigma " +
                                          fixed_text(d.refraction_parallax_sigma_rad / arcsec, 6)),
                "sigma of RA cos(DEC) " + fixed_text(sigma_ra / arcsec, 6) + " arcsec, of DEC " +
                    fixed_text(sigma_dec / arcsec, 6) + " arcsec, correlation " +
                    fixed_text(both > 0.0 ? d.covariance_rad2[1] / both : 0.0, 6) +
                    (d.magnitude == no_magnitude
                         ? ""
                         : ", of MAG " + fixed_text(d.magnitude_sigma, 6) + " in band " + d.band) +
                    "; SNR " + fixed_text(d.snr, 3)};
  if (d.kind == DetectionKind::streak)
    s.comments.push_back("streak of " + fixed_text(d.length_px, 3) + " px, rate " +
                         fixed_text(d.rate_rad_per_s / arcsec, 6) + " arcsec/s, position angle " +
                         fixed_text(d.position_angle_rad / deg, 6) + " deg" +
                         (d.direction_known ? "" : " or opposite"));
  s.corrections = {
      {"CORRECTION_ANGLE_1",
       fixed_text(angle_between_rad(d.corrected_ra_rad, d.ra_rad) / deg, angle_decimals)},
      {"CORRECTION_ANGLE_2", fixed_text((d.corrected_dec_rad - d.dec_rad) / deg, angle_decimals)}};
  if (d.range_m)
    s.comments.push_back("sigma of RANGE " + fixed_text(*d.range_sigma_m / km, 9) + " km");
  if (d.range_rate_m_per_s)
    s.comments.push_back("sigma of DOPPLER_INSTANTANEOUS " +
                         fixed_text(*d.range_rate_sigma_m_per_s / km, 12) + " km/s");
  s.sightings = {{d.time, d.corrected_ra_rad, d.corrected_dec_rad, d.magnitude, d.range_m,
                  d.range_rate_m_per_s}};
  return s;
}

void write_truth(const RunProducts& run, KvnText& kvn) {
  std::vector<Segment> segments;
  std::map<std::pair<std::string, std::string>, std::size_t> place;
  for (const Truth& t : run.truths) {
    if (!t.in_frame || t.sunlit <= 0.0) continue;
    const std::string object = t.catalogue_number > 0 ? std::to_string(t.catalogue_number) : t.name;
    const auto [found, is_new] = place.emplace(std::pair(t.sensor, object), segments.size());
    if (is_new) {
      Segment s{.sensor = t.sensor,
                .object = object,
                .track = t.sensor + "/" + object,
                .exposure_s = (t.end - t.start).seconds(),
                .quality = "VALIDATED"};
      s.comments = {"truth of " + t.name, place_comment(run.sensor(t.sensor)),
                    "angles are geometric at the time when the light left the object: free of "
                    "aberration and refraction",
                    "MAG is V above the atmosphere, mean of the exposure"};
      segments.push_back(std::move(s));
    }
    segments[found->second].sightings.push_back(
        {t.middle, t.true_ra_rad, t.true_dec_rad, t.true_magnitude - 2.5 * std::log10(t.sunlit)});
  }
  if (segments.empty()) fail_empty(run, "a TDM", ProductKind::truth);
  for (const Segment& s : segments) write(run, s, kvn);
}

void write_detections(const RunProducts& run, KvnText& kvn) {
  if (run.detections.empty()) fail_empty(run, "a TDM", ProductKind::detections);
  for (const Detection& d : run.detections) write(run, segment_of(run, d), kvn);
}

/// What confirmed tracks took, of each in the order of time. A detection that two tracks took at
/// different ticks stands in both.
void write_tracks(const RunProducts& run, KvnText& kvn) {
  std::map<std::string, const Detection*> by_id;
  for (const Detection& d : run.detections) by_id.emplace(d.id, &d);
  const auto confirmed = run.confirmed_tracks();
  std::map<std::uint32_t, std::vector<const Detection*>> taken;
  for (const Track& t : run.tracks)
    for (const std::string& id : t.associated)
      if (const auto found = by_id.find(id); confirmed.contains(t.id) && found != by_id.end())
        taken[t.id].push_back(found->second);
  if (taken.empty()) fail_empty(run, "a TDM", ProductKind::tracks);
  for (auto& [id, detections] : taken) {
    const Track& track = *confirmed.at(id);
    std::ranges::stable_sort(detections, {}, &Detection::time);
    for (const Detection* d : detections) {
      Segment s = segment_of(run, *d);
      s.comments.insert(s.comments.begin(),
                        "detection " + d->id + (track.name.empty() ? "" : " of " + track.name));
      s.track = track_name(track);
      s.object = track.catalogue_number > 0 ? std::to_string(track.catalogue_number) : s.track;
      write(run, s, kvn);
    }
  }
}

}  // namespace

std::string tdm_text(const ExportRequest& request) {
  const RunProducts& run = request.run;
  KvnText kvn(run, "CCSDS_TDM_VERS");
  if (request.kind == ProductKind::truth)
    write_truth(run, kvn);
  else if (request.kind == ProductKind::tracks)
    write_tracks(run, kvn);
  else
    write_detections(run, kvn);
  return kvn.take();
}

}  // namespace dmise
