#include "nodes/fusion/own_tracker.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <variant>

#include "core/base/formatted.h"
#include "core/base/printable.h"
#include "core/fusion/live_track.h"
#include "core/tracking/propagate.h"
#include "nodes/wire/state_codec.h"

namespace dmise {
namespace {

constexpr std::size_t max_tracks = 10'000;  // in one tick; 16 MiB of a message are 25,000
constexpr std::uint32_t max_exposures = 1000;
constexpr double max_sigma_m = 1e12, max_sigma_m_per_s = 3e8;

constexpr std::array first_six{0, 1, 2, 3, 4, 5};

OrbitEstimate estimate_of(const Track& t) {
  OrbitEstimate out{
      .state = {t.time, t.position_m, t.velocity_m_per_s, t.drag_m2_per_kg, t.srp_m2_per_kg}};
  for (int row = 0, k = 0; row < 6; ++row)
    for (int column = 0; column <= row; ++column, ++k)
      out.covariance(row, column) = out.covariance(column, row) = t.covariance[std::size_t(k)];
  const auto square = [](double x) { return x * x; };
  out.covariance(drag_row, drag_row) = square(t.drag_sigma_m2_per_kg);
  out.covariance(srp_row, srp_row) = square(t.srp_sigma_m2_per_kg);
  return out;
}

void check_covariance(const Track& t) {
  const OrbitMatrix covariance = estimate_of(t).covariance;
  for (int row = 0; row < 6; ++row) {
    const double limit = row < 3 ? max_sigma_m : max_sigma_m_per_s;
    if (!(covariance(row, row) > 0 && covariance(row, row) <= limit * limit))
      throw Error(formatted("covariance: variance %d must be > 0 and at most %.3g, got %.9g", row,
                            limit * limit, covariance(row, row)));
  }
  const Matrix6 scaled = unit_variances(covariance, first_six).scaled.topLeftCorner<6, 6>();
  if (Eigen::LLT<Matrix6>(scaled).info() != Eigen::Success)
    throw Error("covariance: must be positive definite");
}

bool is_cued(const SensorConfig& sensor) {
  return std::holds_alternative<PointCued>(sensor.pointing);
}

/// Adds what a tracker is told of a sensor.
void add_sensor(const SensorConfig& sensor, v1::OwnNodeTracking& tracking) {
  v1::OwnNodeSensor& one = *tracking.add_sensors();
  describe_sensor(sensor, one);
  one.set_columns(std::uint32_t(sensor.camera.optics.columns));
  one.set_rows(std::uint32_t(sensor.camera.optics.rows));
  one.set_cued(is_cued(sensor));
}

}  // namespace

OwnTracker::OwnTracker(const Scenario& scenario, const ObjectRoster& known, const Clock& clock,
                       OwnNodeSettings settings, Replay replay)
    : scenario_(scenario),
      environment_(clock),
      node_(*std::ranges::find(scenario.own_nodes, scenario.fusion->node, &OwnNode::name)),
      settings_(std::move(settings)),
      replay_(std::move(replay)),
      forces_(clock, SimTime{scenario.duration.ns / 2}),
      restarts_(scenario.network, node_.name, settings_) {
  ObjectRoster told = known;
  for (ObjectInfo& object : told.objects) {
    names_[object.catalogue_number] = object.name;
    object.sphere = {};  // nobody knows its size
    object.panel = {};
  }
  Encoded encoded = encode(State(std::move(told)));
  roster_ = std::move(encoded.payload);
  roster_arrays_ = std::move(encoded.arrays);
  for (const SensorConfig& sensor : scenario.sensors)
    if (is_cued(sensor)) cued_.insert(sensor.name);
}

void OwnTracker::start() {
  v1::OwnNodeBegin begin = begin_of(scenario_, node_);
  for (const SensorConfig& sensor : scenario_.sensors)
    if (sensor.detect) add_sensor(sensor, *begin.mutable_tracking());
  begin.mutable_tracking()->set_cue_delay_ticks(std::uint32_t(scenario_.fusion->cue_delay_ticks));
  said_.continue_at(begin);
  const std::string_view roster[]{roster_, roster_arrays_};
  program_ = settings_.start({scenario_, node_, settings_, begin, restarts_.any(), roster});
}

std::optional<Tracker::Tracked> OwnTracker::step(Tick tick, std::span<const SearchedFrame> frames) {
  while (true) {
    const auto place = [&] { return "tick " + std::to_string(said_.next()); };
    try {
      if (!program_) start();
      auto told = ask_up_to(tick, frames);
      if (!told) return std::nullopt;
      Tracked out = take(std::move(told->tracks), frames);
      if (told->points) out.wishes = wishes_of(*told->points);
      said_.add(told->digest, std::move(told->checkpoint), "tracks");
      if (tick == scenario_.last_tick()) program_.reset();
      return out;
    } catch (const ProgramLost& lost) {
      program_.reset();
      restarts_.after(lost, place());
    } catch (const Error& error) {
      throw Error(settings_.error_prefix + place() + ": " + error.what());
    }
  }
}

/// The answer for a tick, after a program that was started again has heard those before.
OwnTracker::Told OwnTracker::ask_up_to(Tick tick, std::span<const SearchedFrame> frames) {
  if (said_.next() < tick)
    replay_(said_.next(), tick, [&](Tick earlier, std::span<const SearchedFrame> of_it) {
      if (said_.next() != earlier) return;  // after the stop
      if (auto told = ask(earlier, of_it))
        said_.add(told->digest, std::move(told->checkpoint), "tracks");
    });
  if (said_.next() < tick) return std::nullopt;
  return ask(tick, frames);
}

OwnTracker::Told OwnTracker::ask(Tick tick, std::span<const SearchedFrame> frames) {
  v1::OwnNodeTrack request;
  request.set_tick(tick);
  request.set_time_ns(scenario_.time_of(tick).ns);
  request.set_give_checkpoint(OwnRecord::wants_checkpoint(said_.next()));
  std::vector<std::string> payloads{encode(environment_.at(tick, scenario_.time_of(tick))).payload};
  for (const SearchedFrame& frame : frames) {
    payloads.push_back(encode(*frame.report).payload);
    payloads.push_back(encode(*frame.found).payload);
  }
  const std::vector<std::string_view> more(payloads.begin(), payloads.end());
  Told told = program_->track(request, more);
  if (told && (told->tracks.tick != tick || told->tracks.time != scenario_.time_of(tick)))
    throw Error("its tracks are of tick " + std::to_string(told->tracks.tick) + ", " +
                formatted("%.9g", told->tracks.time.seconds()) + " s");
  return told;
}

Tracker::Tracked OwnTracker::take(TrackSet&& set, std::span<const SearchedFrame> frames) {
  if (set.tracks.size() > max_tracks)
    throw Error("tracks: must be at most " + std::to_string(max_tracks) + ", got " +
                std::to_string(set.tracks.size()));
  Sources sources;
  for (const SearchedFrame& frame : frames)
    for (const Detection& d : frame.found->detections) sources[d.id] = {&d};
  for (Track& track : set.tracks) {
    try {
      take(track, sources);
    } catch (const Error& error) {
      throw Error("track " + std::to_string(track.id) + ": " + error.what());
    }
  }
  FusionTick out{.tracks = std::move(set.tracks), .live = std::uint32_t(live_.size())};
  out.unassociated =
      std::uint32_t(std::ranges::count_if(sources, [](const auto& s) { return !s.second.taken; }));
  return {.tracks = std::move(out)};
}

void OwnTracker::take(Track& track, Sources& sources) {
  if (ended_.contains(track.id)) throw Error("id: that track has ended");
  const auto before = live_.find(track.id);
  check(track, before == live_.end() ? nullptr : &before->second);
  if (track.catalogue_number != 0) track.name = names_.at(track.catalogue_number);
  if (track.existence == 0 && track.status != TrackStatus::lost) track.existence = 1;
  Live& live = live_[track.id];
  count(track, live, sources);
  live.track = track;
  if (track.status != TrackStatus::lost) return;
  live_.erase(track.id);
  ended_.insert(track.id);
}

void OwnTracker::check(const Track& track, const Live* before) const {
  check_covariance(track);
  const std::uint32_t number = track.catalogue_number,
                      known = before ? before->track.catalogue_number : 0;
  if (known != 0 && number != known)
    throw Error(formatted("catalogue_number: was %u, got %u: another object is another track",
                          known, number));
  if (number != 0 && !names_.contains(number))
    throw Error(formatted("catalogue_number: the catalogue has no such object, got %u", number));
}

/// Counts the detections that a track took.
void OwnTracker::count(Track& track, Live& live, Sources& sources) const {
  track.detections = live.track.detections;
  track.last_seen = live.track.last_seen;
  for (const std::string& id : track.associated) {
    const auto source = sources.find(id);
    if (source == sources.end())
      throw Error("associated: no detection of this tick, got " + printable(id));
    if (std::exchange(source->second.taken, true))
      throw Error("associated: is taken twice, got " + printable(id));
    const Detection& d = *source->second.detection;
    const Vec<Gcrs> then =
        track.position_m + track.velocity_m_per_s * (d.time - track.time).seconds();
    live.brightness.add(d.magnitude, norm(then - d.sensor_position_m));
    track.last_seen = ++track.detections == 1 ? d.time : std::max(track.last_seen, d.time);
  }
  if (live.brightness.is_known()) track.magnitude = live.brightness.magnitude(1e6);
}

std::vector<CueWish> OwnTracker::wishes_of(const v1::OwnNodePoints& points) const {
  std::vector<CueWish> out;
  for (const v1::OwnNodePoint& point : points.points()) {
    const std::string& sensor = point.sensor();
    const auto fail = [&](const std::string& why) {
      throw Error("tasks: " + printable(sensor) + ": " + why);
    };
    if (!cued_.contains(sensor)) fail("no sensor of this name is cued");
    if (std::ranges::find(out, sensor, &CueWish::sensor) != out.end())
      fail("has two tasks at one tick");
    if (!live_.contains(point.track()))
      fail("there is no live track " + std::to_string(point.track()));
    if (point.exposures() > max_exposures)
      fail("exposures: must be at most " + std::to_string(max_exposures) + ", got " +
           std::to_string(point.exposures()));
    out.push_back({.sensor = sensor, .track = point.track(), .exposures = point.exposures()});
  }
  return out;
}

std::vector<CueTarget> OwnTracker::targets(SimTime time) const {
  std::vector<CueTarget> out;
  for (const auto& [id, live] : live_) {
    const Track& t = live.track;
    auto estimate = propagate(forces_, estimate_of(t), time, {.position_tolerance_m = 1e-2});
    if (!estimate) continue;
    out.push_back({.track = id,
                   .catalogue_number = t.catalogue_number,
                   .name = t.name,
                   .existence = t.existence,
                   .magnitude = t.magnitude,
                   .estimate = std::move(*estimate)});
  }
  return out;
}

}  // namespace dmise
