#include "nodes/gateway/live_view.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "core/base/files/json.h"
#include "core/time/iso8601.h"
#include "core/wcs/wcs.h"
#include "nodes/runtime/process/monotonic_clock.h"
#include "nodes/runtime/security/security.h"

namespace dmise {
namespace {

static_assert(std::endian::native == std::endian::little, "the layout is little endian");

constexpr std::size_t max_tracks = 5000, max_detections = 200;  // detections per frame
constexpr std::size_t max_truths = 500;                         // objects shown of a frame
constexpr int points_per_side = 6;                              // on each side of a field's border
constexpr double unix_epoch_jd = 2440587.5;

template <class F>
void put(JsonWriter& json, std::string_view name, const Vec<F>& v, double scale, double per_unit) {
  // Rounded: a message has many of them, and a screen few pixels.
  const auto round = [&](double x) { return std::round(x * scale * per_unit) / per_unit; };
  json.list(name, {round(v.x), round(v.y), round(v.z)});
}

constexpr double km_per_m = 1e-3;

/// Directions of the border of an image, whose reference pixel is its centre.
std::vector<PixelPosition> border_of(const Wcs& wcs) {
  const double right = 2 * wcs.crpix_x + 0.5, bottom = 2 * wcs.crpix_y + 0.5, first = -0.5;
  const PixelPosition corners[] = {
      {first, first}, {right, first}, {right, bottom}, {first, bottom}};
  std::vector<PixelPosition> border;
  for (int side = 0; side < 4; ++side)
    for (int i = 0; i < points_per_side; ++i) {
      const PixelPosition a = corners[side], b = corners[(side + 1) % 4];
      const double s = double(i) / points_per_side;
      border.push_back({a.x_px + s * (b.x_px - a.x_px), a.y_px + s * (b.y_px - a.y_px)});
    }
  return border;
}

const char* node_state(const NodeStatus& node, const RunStatus& status) {
  if (!node.alive) return "lost";
  if (node.observer) return "observes";
  if (status.phase == Phase::running && !status.paused &&
      std::ranges::find(status.holding, node.name) != status.holding.end())
    return "awaited";
  return "alive";
}

}  // namespace

std::string encode_objects(const ObjectStates& states, const EarthOrientation& earth,
                           double utc_ms) {
  std::string bytes(objects_header_bytes + 12 * states.count, '\0');
  std::memcpy(bytes.data(), "DMOB", 4);
  const auto count = std::uint32_t(states.count);
  const double time_s = states.time.seconds();
  std::memcpy(bytes.data() + 4, &count, 4);
  std::memcpy(bytes.data() + 8, &time_s, 8);
  std::memcpy(bytes.data() + 16, &utc_ms, 8);
  const Rotation<Itrs, Gcrs> itrs_from_gcrs = earth.itrs_from_gcrs(states.time);
  char* at = bytes.data() + objects_header_bytes;
  for (std::size_t i = 0; i < states.count; ++i, at += 12) {
    if (states.code[i] != 0) continue;
    const Vec<Itrs> position = itrs_from_gcrs * states.position(i) * km_per_m;
    const float xyz[] = {float(position.x), float(position.y), float(position.z)};
    std::memcpy(at, xyz, sizeof xyz);
  }
  return bytes;
}

void LiveView::take(const State& state) {
  std::visit([this](const auto& s) { take(s); }, state);
}

void LiveView::take(const ObjectRoster& roster) {
  has_roster_ = true;
  JsonWriter json;
  json.begin_object().field("type", "roster").key("objects").begin_array();
  for (const auto& object : roster.objects)
    json.begin_array().value(object.catalogue_number).value(object.name).end_array();
  latest_.set(MessageSlot::roster, {json.end_array().end_object().take()});
}

void LiveView::take(const ObjectStates& states) {
  if (!earth_) return;  // it is published at the same tick, so the next states have it
  time_s_ = std::max(time_s_, states.time.seconds());
  latest_.set(MessageSlot::objects,
              {encode_objects(states, *earth_, utc_ms(states.time.seconds())), true});
  changed_.insert(MessageSlot::objects);
}

void LiveView::take(const FrameReport& report) {
  if (!earth_) return;
  SensorView& sensor = sensors_[report.sensor];
  if (report.frame < sensor.report.frame) return;  // from a process begun again
  sensor.report = report;
  const Rotation<Itrs, Gcrs> itrs_from_gcrs = earth_->itrs_from_gcrs(report.middle);
  sensor.position_m = itrs_from_gcrs * report.sensor_position_m;
  sensor.boresight =
      itrs_from_gcrs * from_spherical<Gcrs>(report.boresight_ra_rad, report.boresight_dec_rad);
  sensor.field.clear();
  for (const PixelPosition pixel : border_of(report.wcs))
    sensor.field.push_back(itrs_from_gcrs * wcs_direction(report.wcs, pixel));
  time_s_ = std::max(time_s_, report.end.seconds());
  changed_.insert(MessageSlot::sensors);
}

void LiveView::take(const DetectionSet& set) {
  SensorView& sensor = sensors_[set.sensor];
  if (set.frame < sensor.detections_frame) return;
  sensor.detections_frame = set.frame;
  sensor.detections_total += set.detections.size();
  sensor.detections = set.detections;
  if (sensor.detections.size() > max_detections) sensor.detections.resize(max_detections);
  changed_.insert({MessageSlot::detections, MessageSlot::sensors});
}

void LiveView::take(const TruthSet& set) {
  if (!takes_truth_) return;
  SensorView& sensor = sensors_[set.sensor];
  if (set.frame < sensor.truths_frame) return;
  sensor.truths_frame = set.frame;
  sensor.truths.clear();
  for (const Truth& truth : set.truths)
    if (truth.in_frame && sensor.truths.size() < max_truths) sensor.truths.push_back(truth);
  changed_.insert(MessageSlot::truth);
}

void LiveView::take(const TrackSet& set) {
  for (const Track& track : set.tracks) {
    if (track.status == TrackStatus::lost)
      tracks_.erase(track.id);
    else if (tracks_.contains(track.id) || tracks_.size() < max_tracks)
      tracks_[track.id] = track;
  }
  time_s_ = std::max(time_s_, set.time.seconds());
  if (!set.tracks.empty()) changed_.insert(MessageSlot::tracks);
}

void LiveView::take(const TaskSet& set) {
  if (set.tasks.empty()) return;
  sensors_[set.sensor].task = set.tasks.back();
  changed_.insert(MessageSlot::tasks);
}

void LiveView::take(const RunStatus& status, const std::map<std::string, std::uint64_t>& gaps) {
  if (status_ && status_->run_id != status.run_id) forget_run();
  if (!status_ || status_->start_utc != status.start_utc) encode_run(status);
  status_ = status;
  const double now_s = double(now().count()) * 1e-9;
  const auto ticks_per_s = [&](const std::string& name, Tick done) {
    TickRate& rate = progress_[name];
    if (status.paused) rate.reset();
    rate.take(done, now_s);
    return rate.ticks_per_s();
  };
  const double of_clock = ticks_per_s("", status.settled);
  const auto span = history_.span();
  JsonWriter json;
  json.begin_object().field("type", "status");
  json.field("run_id", fmt::format("{:016x}", status.run_id));
  json.field("phase", phase_name(status.phase)).field("paused", status.paused);
  json.field("pace", status.pace);
  json.field("cause", status.cause).field("settled_tick", status.settled);
  json.field("granted_tick", status.granted).field("last_tick", status.last_tick);
  json.field("time_s", double(std::max<Tick>(status.settled, 0)) * status.tick_length.seconds());
  json.field("rate", of_clock * status.tick_length.seconds());
  json.field("ticks_per_s", of_clock);
  json.field("overruns", status.overruns).field("worst_lag_s", status.worst_lag_s);
  json.list("missing", status.missing).list("holding", status.holding);
  json.key("past").begin_object().field("from_s", span.from_s).field("to_s", span.to_s);
  json.field("states", std::uint64_t(span.snapshots)).end_object();
  json.key("nodes").begin_array();
  for (const NodeStatus& node : status.nodes) {
    const auto missed = gaps.find(node.name);
    json.begin_object().field("name", node.name).field("state", node_state(node, status));
    json.field("tick", node.done).field("start", node.incarnation);
    // The broker does no ticks.
    json.field("lag_ticks",
               node.name == broker_name ? Tick(0) : std::max<Tick>(0, status.granted - node.done));
    json.field("ticks_per_s", ticks_per_s(node.name, node.done));
    json.field("compute_s", node.times.compute_s).field("message_s", node.times.messaging_s);
    json.field("wait_s", node.times.waiting_s).field("frames", node.times.frames);
    json.field("detections", node.times.detections);
    json.field("peak_resident_bytes", node.times.peak_resident_bytes);
    json.field("gaps", missed == gaps.end() ? std::uint64_t(0) : missed->second).end_object();
  }
  latest_.set(MessageSlot::status, {json.end_array().end_object().take()});
}

void LiveView::forget_run() {
  history_.clear();
  for (const MessageSlot slot : {MessageSlot::objects, MessageSlot::roster}) latest_.forget(slot);
  earth_.reset();
  status_.reset();
  sensors_.clear();
  tracks_.clear();
  progress_.clear();
  has_roster_ = false;
  time_s_ = 0.0;
  changed_ = {MessageSlot::sensors, MessageSlot::detections, MessageSlot::tracks,
              MessageSlot::tasks};
  if (takes_truth_) changed_.insert(MessageSlot::truth);
}

void LiveView::encode_run(const RunStatus& status) {
  start_utc_ms_.reset();
  if (!status.start_utc.empty()) try {
      const Utc start = parse_utc(status.start_utc);
      start_utc_ms_ = (start.jd1 - unix_epoch_jd + start.jd2) * 86400e3;
    } catch (const ConfigError&) {
      // From another process: shown as it is, without dates.
    }
  JsonWriter json;
  json.begin_object().field("type", "run").field("start_utc", status.start_utc);
  json.field("start_utc_ms", start_utc_ms_);
  json.field("tick_s", status.tick_length.seconds()).field("last_tick", status.last_tick);
  latest_.set(MessageSlot::run, {json.end_object().take()});
}

double LiveView::utc_ms(double time_s) const { return start_utc_ms_.value_or(0.0) + 1e3 * time_s; }

void LiveView::notify(const std::string& text) {
  JsonWriter json;
  json.begin_object().field("type", "notice").field("number", ++notices_).field("text", text);
  latest_.set(MessageSlot::notice, {json.end_object().take()});
}

std::string LiveView::sensors_json() const {
  JsonWriter json;
  json.begin_object().field("type", "sensors").key("sensors").begin_array();
  for (const auto& [name, sensor] : sensors_) {
    const FrameReport& report = sensor.report;
    if (report.frame == 0) continue;
    json.begin_object().field("name", name).field("frame", report.frame);
    json.field("start_s", report.start.seconds()).field("end_s", report.end.seconds());
    json.field("columns", std::int64_t(std::lround(2 * report.wcs.crpix_x + 1)));
    json.field("rows", std::int64_t(std::lround(2 * report.wcs.crpix_y + 1)));
    json.field("ra_rad", report.boresight_ra_rad).field("dec_rad", report.boresight_dec_rad);
    json.field("scale_rad", wcs_scale_rad_per_px(report.wcs));
    json.field("limiting_magnitude",
               report.limiting_magnitude - report.magnitudes.solar_colour_mag);
    json.field("background_e", report.background_e).field("noise_e", report.noise_e);
    json.field("stars_expected", report.stars_expected).field("stars_found", report.stars_found);
    json.field("objects_rendered", report.objects_rendered);
    json.field("detections", report.detections).field("detection_off", report.detection_off);
    json.field("shutter_closed", report.shutter_closed);
    json.field("detections_total", sensor.detections_total);
    put(json, "position_km", sensor.position_m, km_per_m, 1e3);
    put(json, "boresight", sensor.boresight, 1.0, 1e6);
    json.key("field").begin_array();
    for (const auto& direction : sensor.field)
      for (const double x : {direction.x, direction.y, direction.z})
        json.value(std::round(x * 1e5) / 1e5);
    json.end_array().end_object();
  }
  return json.end_array().end_object().take();
}

std::string LiveView::detections_json() const {
  JsonWriter json;
  json.begin_object().field("type", "detections").key("detections").begin_array();
  for (const auto& [name, sensor] : sensors_)
    for (const Detection& d : sensor.detections) {
      json.begin_object().field("id", d.id).field("sensor", name).field("frame", d.frame);
      json.field("time_s", d.time.seconds());
      json.field("kind", d.kind == DetectionKind::streak ? "streak" : "point");
      json.field("x_px", d.x_px).field("y_px", d.y_px).field("magnitude", d.magnitude);
      json.field("snr", d.snr).field("ra_rad", d.ra_rad).field("dec_rad", d.dec_rad);
      json.list("ends_px", {d.end1_x_px, d.end1_y_px, d.end2_x_px, d.end2_y_px});
      if (earth_) {
        const auto itrs_from_gcrs = earth_->itrs_from_gcrs(d.time);
        put(json, "from_km", itrs_from_gcrs * d.sensor_position_m, km_per_m, 1e3);
        put(json, "direction",
            itrs_from_gcrs * from_spherical<Gcrs>(d.corrected_ra_rad, d.corrected_dec_rad), 1.0,
            1e6);
      }
      json.end_object();
    }
  return json.end_array().end_object().take();
}

std::string LiveView::tracks_json() const {
  JsonWriter json;
  json.begin_object().field("type", "tracks").key("tracks").begin_array();
  for (const auto& [id, track] : tracks_) {
    if (!earth_) break;
    const auto itrs_from_gcrs = earth_->itrs_from_gcrs(track.time);
    // The largest axis is at most the root of the trace.
    const double variance = track.covariance[0] + track.covariance[2] + track.covariance[5];
    json.begin_object().field("id", id).field("status", name_of(track.status));
    json.field("time_s", track.time.seconds()).field("last_seen_s", track.last_seen.seconds());
    json.field("number", track.catalogue_number).field("name", track.name);
    json.field("detections", track.detections).field("existence", track.existence);
    json.field("sigma_km", std::sqrt(std::max(0.0, variance)) * km_per_m);
    put(json, "position_km", itrs_from_gcrs * track.position_m, km_per_m, 1e3);
    json.end_object();
  }
  return json.end_array().end_object().take();
}

std::string LiveView::tasks_json() const {
  JsonWriter json;
  json.begin_object().field("type", "tasks").key("tasks").begin_array();
  for (const auto& [name, sensor] : sensors_) {
    if (!sensor.task || !earth_) continue;
    const Task& task = *sensor.task;
    json.begin_object().field("id", task.id).field("sensor", name).field("track", task.track);
    json.field("number", task.catalogue_number).field("name", task.name);
    json.field("start_s", task.start.seconds()).field("on_target_s", task.on_target.seconds());
    json.field("end_s", task.end.seconds()).field("exposures", task.exposures);
    json.field("gain_nats", task.gain_nats).field("sigma_rad", task.sigma_rad);
    json.key("path_km").begin_array();
    for (std::size_t i = 0; i + 2 < task.path_m.size(); i += 3) {
      const SimTime at = task.path_start + sim_seconds(double(i / 3) * task.path_step_s);
      const Vec<Itrs> p = earth_->itrs_from_gcrs(at) *
                          Vec<Gcrs>{task.path_m[i], task.path_m[i + 1], task.path_m[i + 2]};
      for (const double x : {p.x, p.y, p.z}) json.value(std::round(x) * km_per_m);
    }
    json.end_array().end_object();
  }
  return json.end_array().end_object().take();
}

std::string LiveView::truth_json() const {
  JsonWriter json;
  json.begin_object().field("type", "truth").key("truths").begin_array();
  for (const auto& [name, sensor] : sensors_)
    for (const Truth& t : sensor.truths) {
      json.begin_object().field("sensor", name).field("frame", sensor.truths_frame);
      json.field("number", t.catalogue_number).field("name", t.name);
      json.field("magnitude", t.true_magnitude).field("signal_e", t.rendered_signal_e);
      json.list("path_px",
                {t.start_x_px, t.start_y_px, t.middle_x_px, t.middle_y_px, t.end_x_px, t.end_y_px});
      json.end_object();
    }
  return json.end_array().end_object().take();
}

void LiveView::publish() {
  if (changed_.empty()) return;
  if (changed_.contains(MessageSlot::sensors)) latest_.set(MessageSlot::sensors, {sensors_json()});
  if (changed_.contains(MessageSlot::detections))
    latest_.set(MessageSlot::detections, {detections_json()});
  if (changed_.contains(MessageSlot::tracks)) latest_.set(MessageSlot::tracks, {tracks_json()});
  if (changed_.contains(MessageSlot::tasks)) latest_.set(MessageSlot::tasks, {tasks_json()});
  if (changed_.contains(MessageSlot::truth)) latest_.set(MessageSlot::truth, {truth_json()});
  changed_.clear();
  remember();
}

void LiveView::remember() {
  ViewSnapshot snapshot{time_s_, {}};
  for (const MessageSlot slot : slots_of_history)
    if (auto message = latest_.of(slot)) snapshot.messages.push_back(std::move(message));
  history_.add(std::move(snapshot));
}

}  // namespace dmise
