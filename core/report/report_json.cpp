#include "core/report/report_json.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <span>

#include "core/base/error.h"
#include "core/base/files/json.h"
#include "core/base/numeric/quantile.h"
#include "core/base/units.h"
#include "core/image/fits_file.h"
#include "core/report/direction_grid.h"
#include "core/report/embedded_image.h"
#include "core/report/stars_in_frame.h"

namespace dmise {
namespace {

constexpr std::size_t max_stars = 60;  // marked in a frame
constexpr std::size_t max_tracks = 300, max_cues = 500, max_ticks = 4000, max_files = 300;

double rounded(double value, int digits) {
  const double scale = std::pow(10.0, digits);
  return std::round(value * scale) / scale;
}

double degrees(double rad) { return rounded(rad / deg, 6); }

/// `value` with so many decimals; null if it is not known or not finite.
void number(JsonWriter& json, std::optional<double> value, int digits) {
  if (value && std::isfinite(*value))
    json.value(rounded(*value, digits));
  else
    json.null();
}

void number(JsonWriter& json, const char* name, std::optional<double> value, int digits) {
  json.key(name);
  number(json, value, digits);
}

void pixel(JsonWriter& json, PixelPosition p) {
  number(json, p.x_px, 2);
  number(json, p.y_px, 2);
}

/// Where a direction is in a sensor's plot of the sky: azimuth and elevation over the ground, right
/// ascension and declination in orbit. The pole is that of ICRS, so azimuths are right to 0.2 deg.
class SkyPlace {
 public:
  SkyPlace(const RunSensor& sensor, const Vec<Gcrs>& position_m) {
    if (!sensor.site || norm(position_m) == 0.0) return;
    const double latitude = sensor.site->latitude_deg * deg;
    const double turned = std::atan2(position_m.y, position_m.x);
    const Vec<Gcrs> up{std::cos(latitude) * std::cos(turned), std::cos(latitude) * std::sin(turned),
                       std::sin(latitude)};
    const Vec<Gcrs> east{-std::sin(turned), std::cos(turned), 0.0};
    axes_ = {east, cross(up, east), up};
  }
  std::pair<double, double> of(const Vec<Gcrs>& direction) const {
    const Vec<Gcrs> v = unit(direction);
    const double x = axes_ ? dot(v, (*axes_)[1]) : v.x, y = axes_ ? dot(v, (*axes_)[0]) : v.y;
    const double z = axes_ ? dot(v, (*axes_)[2]) : v.z;
    double angle = std::atan2(y, x) / deg;
    if (angle < 0.0) angle += 360.0;
    return {rounded(angle, 2), rounded(std::asin(std::clamp(z, -1.0, 1.0)) / deg, 2)};
  }

 private:
  std::optional<std::array<Vec<Gcrs>, 3>> axes_;  // north, east and up
};

/// Everything of one frame that is read from its FITS file; the problem if it can't be read.
std::string view_of(const RunContents& run, const ReportFrame& row, const StarMap* stars,
                    std::size_t max_pixels) {
  JsonWriter json;
  json.begin_object();
  try {
    const Frame frame = read_frame(run.directory + "/" + row.fits);
    const FrameHeader& h = frame.header;
    const int columns = frame.counts.columns, rows = frame.counts.rows;
    const EmbeddedImage image = embed(frame.counts, max_pixels);
    json.field("columns", columns).field("rows", rows).field("bin", image.bin);
    json.field("across", image.columns).field("down", image.rows);
    json.field("least_dn", image.min_dn).field("step_dn", image.step_dn);
    json.field("pixels", image.pixels);
    json.field("band", h.band.name).field("exposure_s", h.exposure_s);
    if (h.unknown.has(FrameFact::pointing)) return json.end_object().take();
    json.field("arcsec_per_px", wcs_scale_rad_per_px(h.wcs) / arcsec);
    const DirectionGrid grid = direction_grid(h.wcs, columns, rows);
    json.key("grid").begin_object();
    json.field("across", grid.across).field("down", grid.down);
    json.field("error_px", rounded(grid.error_px, 4)).field("nodes", grid.nodes);
    if (grid.sky_across > 0) {
      json.field("sky_across", grid.sky_across).field("sky_down", grid.sky_down);
      json.field("sky", grid.sky);
    }
    json.end_object();
    const SkyPlace place(run.sensors[row.sensor].sensor, row.sensor_position_m);
    json.key("outline").begin_array();
    constexpr int pieces = 8;  // along each side
    const double right = columns - 1, bottom = rows - 1;
    for (int k = 0; k < 4 * pieces; ++k) {
      const double u = double(k % pieces) / pieces;
      const PixelPosition edge = k < pieces       ? PixelPosition{u * right, 0}
                                 : k < 2 * pieces ? PixelPosition{right, u * bottom}
                                 : k < 3 * pieces ? PixelPosition{(1 - u) * right, bottom}
                                                  : PixelPosition{0, (1 - u) * bottom};
      if (!wcs_sees_sky(h.wcs, edge)) continue;
      const auto [angle, height] = place.of(wcs_direction(h.wcs, edge));
      json.begin_array().value(angle).value(height).end_array();
    }
    json.end_array();
    if (stars && h.observation.start_mjd) {
      const double jyear = 2000.0 + (*h.observation.start_mjd - 51544.5) / 365.25;
      json.key("stars").begin_array();
      for (const StarInFrame& s : stars_in_frame(*stars, h.wcs, columns, rows, jyear, max_stars)) {
        json.begin_array().value(s.id);
        pixel(json, s.pixel);
        json.value(degrees(s.ra_rad)).value(degrees(s.dec_rad));
        json.value(rounded(s.v_mag, 2)).end_array();
      }
      json.end_array();
    }
  } catch (const Error& error) {
    return JsonWriter().begin_object().field("problem", error.what()).end_object().take();
  }
  return json.end_object().take();
}

void write_sensors(const RunContents& run, JsonWriter& json) {
  std::vector<std::vector<double>> limits(run.sensors.size());
  for (const ReportFrame& f : run.frames)
    if (f.limiting_magnitude) limits[f.sensor].push_back(*f.limiting_magnitude);
  json.key("sensors").begin_array();
  for (std::size_t s = 0; s < run.sensors.size(); ++s) {
    const ReportSensor& sensor = run.sensors[s];
    const RunSensor& described = sensor.sensor;
    json.begin_object().field("name", described.name).field("camera", described.camera);
    if (const auto& site = described.site)
      json.list("site", {site->latitude_deg, site->longitude_deg, site->height_m});
    if (!described.platform.empty()) json.field("platform", described.platform);
    json.field("columns", described.columns).field("rows", described.rows);
    json.field("exposure_s", described.exposure_s).field("cadence_s", described.cadence_s);
    json.field("frames", sensor.frames);
    json.field("detections", sensor.detections);
    if (!sensor.log.empty()) json.field("log", sensor.log);
    number(json, "seconds_per_frame",
           sensor.costs > 0 ? std::optional(sensor.seconds_per_frame) : std::nullopt, 3);
    number(json, "memory_mb", sensor.memory_mb > 0 ? std::optional(sensor.memory_mb) : std::nullopt,
           0);
    number(json, "limiting_magnitude",
           limits[s].empty() ? std::nullopt : std::optional(middle_of(limits[s])), 2);
    for (const SensorScore& score : run.score.sensors) {
      if (score.sensor != described.name || !run.has_truth) continue;
      json.key("fates").begin_object();
      for (std::size_t k = 0; k < fate_names.size(); ++k) json.field(fate_names[k], score.fates[k]);
      json.end_object();
      json.field("false_alarms", score.false_alarms);
      number(json, "pd",
             score.detection.truths > 0
                 ? std::optional(double(score.detection.found) / double(score.detection.truths))
                 : std::nullopt,
             4);
    }
    json.end_object();
  }
  json.end_array();
}

void write_frames(const RunContents& run, const DrawnFrames& choice, JsonWriter& json) {
  std::vector<std::int64_t> view(choice.frames.size(), -1);
  for (std::size_t k = 0; k < choice.viewed.size(); ++k) view[choice.viewed[k]] = std::int64_t(k);
  json.key("frames").begin_array();
  for (std::size_t row = 0; row < choice.frames.size(); ++row) {
    const ReportFrame& f = run.frames[choice.frames[row]];
    json.begin_object().field("sensor", f.sensor).field("number", f.number);
    json.field("time_s", rounded(f.middle.seconds(), 3)).field("utc", f.middle_utc);
    const auto [angle, height] =
        SkyPlace(run.sensors[f.sensor].sensor, f.sensor_position_m)
            .of(from_spherical<Gcrs>(f.boresight_ra_rad, f.boresight_dec_rad));
    json.list("pointing", {angle, height});
    number(json, "limit", f.limiting_magnitude, 2);
    number(json, "noise_e", f.noise_e, 2);
    number(json, "background_e", f.background_e, 1);
    json.field("stars_found", f.stars_found);
    json.field("stars_expected", f.stars_expected);
    number(json, "seconds", f.total_s, 3);
    number(json, "predicted", f.predicted_s, 3);
    if (!f.fits.empty()) json.field("fits", f.fits);
    if (!f.picture.empty()) json.field("picture", f.picture);
    if (!f.marked.empty()) json.field("marked", f.marked);
    if (view[row] >= 0) json.field("view", view[row]);
    if (!choice.with_sources[choice.frames[row]]) json.field("sources", false);
    json.end_object();
  }
  json.end_array();
}

/// Rows: frame, object, fate, start, middle and end [px], light [px] or null, RA and Dec [deg], V,
/// expected SNR, range [km], and the place in the plot of the sky.
void write_truths(const RunContents& run, const DrawnFrames& choice, JsonWriter& json) {
  std::vector<std::string> objects;
  std::map<std::string, std::size_t> place_of;
  json.key("truths").begin_array();
  for (const ReportTruth& t : run.truths) {
    if (!choice.with_sources[t.frame]) continue;
    const ScoredTruth& scored = run.score.truths[t.scored];
    const ReportFrame& f = run.frames[t.frame];
    const auto [found, is_new] = place_of.emplace(scored.truth.id, objects.size());
    if (is_new) objects.push_back(scored.truth.id);
    json.begin_array().value(choice.row_of[t.frame]);
    json.value(found->second).value(int(scored.fate));
    pixel(json, scored.truth.start);
    pixel(json, scored.truth.middle);
    pixel(json, scored.truth.end);
    json.value(degrees(t.truth.true_ra_rad)).value(degrees(t.truth.true_dec_rad));
    number(json, scored.truth.magnitude, 2);
    number(json, scored.snr, 2);
    json.value(rounded(t.truth.true_range_m / 1e3, 1));
    const auto [angle, height] =
        SkyPlace(run.sensors[f.sensor].sensor, f.sensor_position_m)
            .of(from_spherical<Gcrs>(t.truth.apparent_ra_rad, t.truth.apparent_dec_rad));
    json.value(angle).value(height).end_array();
  }
  json.end_array().list("objects", objects).list("fate_names", fate_names);
}

/// Rows: frame, 1 if it is a streak, 1 if it is of a truth, centroid and both ends [px], RA and Dec
/// [deg], magnitude, SNR.
void write_detections(const RunContents& run, const DrawnFrames& choice, JsonWriter& json) {
  json.key("detections").begin_array();
  for (const ReportDetection& found : run.detections) {
    if (!choice.with_sources[found.frame]) continue;
    const Detection& d = found.detection;
    json.begin_array().value(choice.row_of[found.frame]);
    json.value(int(d.kind == DetectionKind::streak)).value(int(found.of_truth));
    pixel(json, {d.x_px, d.y_px});
    pixel(json, {d.end1_x_px, d.end1_y_px});
    pixel(json, {d.end2_x_px, d.end2_y_px});
    json.value(degrees(d.ra_rad)).value(degrees(d.dec_rad));
    number(json, d.magnitude, 2);
    number(json, d.snr, 2);
    json.end_array();
  }
  json.end_array();
}

void write_bins(JsonWriter& json, const char* key, const std::vector<Bin>& bins) {
  json.key(key).begin_array();
  for (const Bin& bin : bins) {
    json.begin_object();
    number(json, "from", bin.from, 3);
    number(json, "to", bin.to, 3);
    json.field("truths", bin.truths).field("found", bin.found);
    json.field("low", rounded(bin.probability.low, 4));
    json.field("high", rounded(bin.probability.high, 4));
    number(json, "theory", bin.theory, 4);
    json.end_object();
  }
  json.end_array();
}

void write_score(const RunContents& run, JsonWriter& json) {
  if (!run.has_truth) return;
  json.key("score").begin_array();
  for (const SensorScore& score : run.score.sensors) {
    json.begin_object().field("sensor", score.sensor);
    write_bins(json, "by_snr", score.by_snr);
    write_bins(json, "by_magnitude", score.by_magnitude);
    json.end_object();
  }
  json.end_array();
}

void write_plan(const RunContents& run, JsonWriter& json) {
  json.key("plan").begin_array();
  for (std::size_t s = 0; s < run.sensors.size(); ++s)
    for (const auto& [effect, cost] : run.sensors[s].effects) {
      if (cost.levels.empty() && cost.measured_s == 0.0) continue;
      const double costs = double(std::max<std::size_t>(1, run.sensors[s].costs));
      json.begin_object().field("sensor", s).field("effect", effect);
      json.key("levels").begin_object();
      for (const auto& [level, frames] : cost.levels) json.field(level, frames);
      json.end_object().field("why", cost.why);
      number(json, "predicted_s",
             cost.planned_frames > 0 ? std::optional(cost.predicted_s / double(cost.planned_frames))
                                     : std::nullopt,
             6);
      json.field("measured_s", rounded(cost.measured_s / costs, 6)).end_object();
    }
  json.end_array();
}

void write_tracks(const RunContents& run, JsonWriter& json) {
  std::vector<const ReportTrack*> tracks;
  for (const ReportTrack& t : run.tracks) tracks.push_back(&t);
  const auto rank = [](const ReportTrack* t) {
    return (t->last.catalogue_number == 0 ? 1'000'000'000ull : 0ull) + 1'000'000ull * t->cues +
           t->last.detections;
  };
  std::ranges::stable_sort(tracks, std::ranges::greater(), rank);
  json.field("track_count", tracks.size());
  if (tracks.size() > max_tracks) tracks.resize(max_tracks);
  json.key("tracks").begin_array();
  std::size_t curves = 0;
  for (const ReportTrack* t : tracks) {
    json.begin_object().field("id", t->last.id).field("name", t->last.name);
    json.field("number", t->last.catalogue_number);
    json.field("status", name_of(t->last.status));
    json.field("detections", t->last.detections).field("cues", t->cues);
    json.field("first_s", rounded(t->first_s, 3));
    json.field("last_s", rounded(t->last.time.seconds(), 3));
    json.field("altitude_km", rounded((norm(t->last.position_m) - 6371000.0) / 1e3, 0));
    number(json, "sigma_m",
           t->sigma_m.empty() ? std::nullopt : std::optional(t->sigma_m.back().second), 1);
    if (t->sigma_m.size() > 1 && curves++ < 40) {
      json.key("curve").begin_array();
      for (const auto& [time_s, sigma_m] : t->sigma_m)
        json.begin_array().value(rounded(time_s, 2)).value(rounded(sigma_m, 2)).end_array();
      json.end_array();
    }
    json.end_object();
  }
  json.end_array().field("cue_count", run.cues.size()).key("cues").begin_array();
  for (std::size_t k = 0; k < std::min(max_cues, run.cues.size()); ++k) {
    const Task& cue = run.cues[k];
    json.begin_object().field("sensor", cue.sensor).field("track", cue.track);
    json.field("name", cue.name).field("number", cue.catalogue_number);
    json.field("from_s", rounded(cue.on_target.seconds(), 3));
    json.field("to_s", rounded(cue.end.seconds(), 3)).field("exposures", cue.exposures);
    json.field("gain_nats", rounded(cue.gain_nats, 3)).end_object();
  }
  json.end_array();
}

void write_breakups(const RunContents& run, JsonWriter& json) {
  if (run.breakups.empty()) return;
  json.key("breakups").begin_array();
  for (const FoundBreakup& b : run.breakups) {
    json.begin_object().field("number", b.breakup).field("time_s", rounded(b.time.seconds(), 3));
    json.field("time_sigma_s", rounded(b.time_sigma_s, 3)).field("parent", b.parent);
    json.field("altitude_km", rounded((norm(b.position_m) - 6371000.0) / 1e3, 0));
    json.field("confidence", rounded(b.confidence, 4)).list("members", b.members).end_object();
  }
  json.end_array();
}

void write_clock(const RunContents& run, JsonWriter& json) {
  json.key("nodes").begin_array();
  for (const RunNode& n : run.record.nodes) {
    json.begin_object().field("name", n.name).field("compute_s", rounded(n.compute_s, 3));
    json.field("messaging_s", rounded(n.messaging_s, 3));
    json.field("waiting_s", rounded(n.waiting_s, 3)).field("start_s", rounded(n.start_s, 3));
    json.end_object();
  }
  json.end_array().key("waited_for").begin_array();
  for (const auto& [name, seconds] : run.waited_for_s)
    json.begin_array().value(name).value(rounded(seconds, 2)).end_array();
  json.end_array().field("tick_count", run.ticks.size());
  json.key("ticks").begin_array();
  const std::size_t first = run.ticks.size() > max_ticks ? run.ticks.size() - max_ticks : 0;
  for (std::size_t k = first; k < run.ticks.size(); ++k) {
    const ReportTick& t = run.ticks[k];
    json.begin_array().value(std::int64_t(t.tick)).value(rounded(t.granted_s, 4));
    json.value(rounded(t.settled_s, 4)).value(t.last).end_array();
  }
  json.end_array();
}

}  // namespace

std::string report_json(const RunContents& run, const StarMap* stars, Threads& threads,
                        const ReportSettings& settings) {
  const DrawnFrames choice = choose_frames(run, settings);
  JsonWriter json;
  json.begin_object().field("status", run.record.status.empty() ? "unknown" : run.record.status);
  json.field("how", run.record.how)
      .field("reason", run.record.reason)
      .field("software", run.record.software);
  json.field("digest", run.record.digest)
      .field("seed", run.record.seed)
      .field("start_utc", run.record.start_utc);
  json.field("duration_s", run.record.duration.seconds())
      .field("tick_s", run.record.tick.seconds());
  number(json, "wall_s", run.record.wall_s, 2);
  json.field("parts", run.record.parts);
  json.field("every", choice.every);
  json.field("source_every", choice.source_every);
  json.field("frame_count", run.frames.size());
  json.field("has_truth", run.has_truth);
  write_sensors(run, json);
  write_frames(run, choice, json);
  write_truths(run, choice, json);
  write_detections(run, choice, json);
  write_score(run, json);
  write_plan(run, json);
  write_tracks(run, json);
  write_breakups(run, json);
  write_clock(run, json);
  json.list("files", std::span(run.files).first(std::min(max_files, run.files.size())));
  // Differences of noise in thirds of it take 4.6 bits a pixel.
  const std::size_t max_pixels =
      std::clamp<std::size_t>(std::size_t(double(settings.max_pixel_bytes) * 0.75 * 8 / 4.6) /
                                  std::max<std::size_t>(1, choice.viewed.size()),
                              30'000, 1'500'000);
  std::vector<std::string> views(choice.viewed.size());
  threads.for_ranges(views.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      views[k] = view_of(run, run.frames[choice.frames[choice.viewed[k]]], stars, max_pixels);
  });
  json.key("views").begin_array();
  for (const std::string& view : views) json.raw(view);
  json.end_array().end_object();
  return json.text();
}

}  // namespace dmise
