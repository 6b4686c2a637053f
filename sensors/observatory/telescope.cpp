#include "sensors/observatory/telescope.h"

#include <algorithm>
#include <cmath>

namespace dmise {
namespace {

constexpr double elevation_slack_deg = 1e-6;
constexpr SimTime max_pulse{60'000'000'000};

[[noreturn]] void refuse(const std::string& reason) {
  throw DeviceError(DeviceFault::invalid_operation, reason);
}
[[noreturn]] void refuse_value(const std::string& reason) {
  throw DeviceError(DeviceFault::invalid_value, reason);
}

double elevation_deg(const Vec<Enu>& d) { return horizontal(d).elevation_rad / deg; }

double turned(double angle_deg) {
  const double within = std::fmod(angle_deg, 360.0);
  return within < 0.0 ? within + 360.0 : within;
}

/// Declinations end at the poles.
Equatorial moved(const Equatorial& from, double ra_deg, double dec_deg) {
  return {turned(from.ra_deg + ra_deg), std::clamp(from.dec_deg + dec_deg, -90.0, 90.0)};
}

/// The direction at a part of the way along the great circle.
Vec<Enu> between(const Vec<Enu>& from, const Vec<Enu>& to, double part) {
  const double angle = angle_rad(from, to);
  if (angle < 1e-12 || part >= 1.0) return to;
  Vec<Enu> axis = cross(from, to);
  if (norm(axis) < 1e-9)
    axis = cross(from, std::abs(from.z) < 0.9 ? Vec<Enu>{0, 0, 1} : Vec<Enu>{1, 0, 0});
  const Vec<Enu> side = cross(unit(axis), from);
  return unit(from * std::cos(part * angle) + side * std::sin(part * angle));
}

/// Turns a direction about the pole by an hour angle, west positive, and in declination.
Vec<Enu> turned_axes(const Vec<Enu>& d, double latitude_deg, double west_deg, double north_deg) {
  const Vec<Enu> pole = pole_of(latitude_deg);
  const double dec =
      std::clamp(std::asin(std::clamp(dot(d, pole), -1.0, 1.0)) + north_deg * deg, -pi / 2, pi / 2);
  const double ha = hour_angle_rad(d, latitude_deg) + west_deg * deg;
  const Vec<Enu> south{0.0, -std::sin(latitude_deg * deg), std::cos(latitude_deg * deg)};
  const Vec<Enu> west{-1.0, 0.0, 0.0};
  return pole * std::sin(dec) + (south * std::cos(ha) + west * std::sin(ha)) * std::cos(dec);
}

double seconds_between(SimTime from, SimTime to) { return std::max(0.0, (to - from).seconds()); }

}  // namespace

Telescope::Telescope(const TelescopeSettings& settings, const SiteSky& sky)
    : settings_(settings),
      sky_(sky),
      ra_guide_(0.5 * sidereal_deg_per_s),
      dec_guide_(0.5 * sidereal_deg_per_s),
      park_(home()) {
  path_.stands = home();
  side_ = side_of(path_.stands);
}

Vec<Enu> Telescope::home() const {
  const double elevation = std::clamp(std::abs(settings_.latitude_deg),
                                      std::min(settings_.min_elevation_deg + 1.0, 89.0), 89.0);
  return direction_of(Horizontal{settings_.latitude_deg < 0.0 ? pi : 0.0, elevation * deg});
}

PierSide Telescope::side_of(const Vec<Enu>& direction) const {
  return hour_angle_rad(direction, settings_.latitude_deg) >= 0.0 ? PierSide::east : PierSide::west;
}

Equatorial Telescope::base_at(SimTime t) const {
  const double t_s = seconds_between(path_.since, t);
  double moved_deg[2] = {(ra_rate_ + axis_rates_[0]) * t_s, (dec_rate_ + axis_rates_[1]) * t_s};
  for (int axis = 0; axis < 2; ++axis)
    if (const auto& pulse = pulses_[axis])
      moved_deg[axis] +=
          pulse->rate_deg_per_s * seconds_between(pulse->start, std::min(t, pulse->end));
  return moved(path_.base, moved_deg[0], moved_deg[1]);
}

Vec<Enu> Telescope::on_path(SimTime t) const {
  if (path_.moving) return path_.moving(t);
  if (path_.follows) return sky_.seen(base_at(t), t);
  if (axis_rates_[0] == 0.0 && axis_rates_[1] == 0.0) return path_.stands;
  const double t_s = seconds_between(path_.since, t);
  return turned_axes(path_.stands, settings_.latitude_deg, -axis_rates_[0] * t_s,
                     axis_rates_[1] * t_s);
}

Vec<Enu> Telescope::direction(SimTime t) const {
  if (!slew_ || t >= slew_->arrival) return on_path(t);
  const double part = (t - slew_->start).seconds() / (slew_->arrival - slew_->start).seconds();
  return between(slew_->from, on_path(t), std::max(0.0, part));
}

void Telescope::advance(SimTime now) {
  if (slew_ && now >= slew_->end) {
    if (slew_->then_stands) stand_at(on_path(slew_->end), slew_->end);
    slew_.reset();
  }
  if (!slew_ && path_.follows)
    for (auto& pulse : pulses_)
      if (pulse && now >= pulse->end) begin_at(now);
  if (slew_) return;
  const Vec<Enu> at = on_path(now);
  if (elevation_deg(at) >= settings_.min_elevation_deg - elevation_slack_deg) return;
  // It stops where its limit is.
  Horizontal limit = horizontal(at);
  limit.elevation_rad = settings_.min_elevation_deg * deg;
  axis_rates_[0] = axis_rates_[1] = 0.0;
  stand_at(direction_of(limit), now);
}

void Telescope::begin_at(SimTime t) {
  if (path_.follows)
    path_.base = base_at(t);
  else
    path_.stands = on_path(t);
  path_.since = std::max(t, path_.since);
  for (auto& pulse : pulses_) {
    if (pulse && t >= pulse->end) pulse.reset();
    if (pulse) pulse->start = std::max(t, pulse->start);
  }
}

void Telescope::stand_at(const Vec<Enu>& direction, SimTime now) {
  path_ = {.follows = false, .base = {}, .stands = direction, .since = now};
  for (auto& pulse : pulses_) pulse.reset();
}

void Telescope::need_rest(SimTime now) {
  advance(now);
  need_unparked();
  if (now < held_until_)
    refuse(
        "an exposure is open, whose frame would not show the motion: wait for its end or abort it");
}

void Telescope::need_unparked() const {
  if (parks_ && !slew_)
    throw DeviceError(DeviceFault::invalid_while_parked, "the telescope is parked");
}

void Telescope::need_stars() const {
  if (path_.moving) refuse("the telescope follows a satellite: end that first");
}

void Telescope::need_elevation(const Vec<Enu>& direction) const {
  if (elevation_deg(direction) < settings_.min_elevation_deg - elevation_slack_deg)
    refuse_value("the place is below the least elevation, " +
                 std::to_string(settings_.min_elevation_deg) + " deg");
}

void Telescope::begin_slew(const Vec<Enu>& from, SimTime now) {
  const Vec<Enu> to = on_path(now);
  const double angle_deg = angle_rad(from, to) / deg;
  const SimTime arrival = now + sim_seconds(angle_deg / settings_.slew_rate_deg_per_s);
  slew_ = Slew{from, now, arrival, arrival + sim_seconds(settings_.settle_s)};
  path_.since = slew_->end;  // its rates act from then on
  side_ = side_of(on_path(arrival));
  homes_ = parks_ = false;
}

void Telescope::slew_to(const Equatorial& icrs, SimTime now) {
  need_rest(now);
  if (!path_.follows) refuse("the telescope does not track: set Tracking before this slew");
  go_to(icrs, true, now);
}

void Telescope::go_to(const Equatorial& icrs, bool then_tracks, SimTime now) {
  need_rest(now);
  const Equatorial pointed = moved(icrs, -offset_.ra_deg, -offset_.dec_deg);
  need_elevation(sky_.seen(pointed, now));
  const Vec<Enu> from = direction(now);
  axis_rates_[0] = axis_rates_[1] = 0.0;
  for (auto& pulse : pulses_) pulse.reset();
  path_ = {.follows = true, .base = pointed, .stands = {}, .since = now};
  begin_slew(from, now);
  slew_->then_stands = !then_tracks;
}

void Telescope::slew_to(const Horizontal& place, SimTime now) {
  need_rest(now);
  if (path_.follows) refuse("the telescope tracks: end Tracking before this slew");
  need_elevation(direction_of(place));
  const Vec<Enu> from = direction(now);
  axis_rates_[0] = axis_rates_[1] = 0.0;
  stand_at(direction_of(place), now);
  begin_slew(from, now);
}

void Telescope::follow(std::function<Vec<Enu>(SimTime)> path, SimTime now) {
  need_rest(now);
  need_elevation(path(now));
  const Vec<Enu> from = direction(now);
  axis_rates_[0] = axis_rates_[1] = 0.0;
  for (auto& pulse : pulses_) pulse.reset();
  path_ = {.follows = true, .base = {}, .stands = {}, .since = now, .moving = std::move(path)};
  begin_slew(from, now);
}

void Telescope::abort_slew(SimTime now) {
  need_rest(now);
  const Vec<Enu> here = direction(now);
  if (axis_rates_[0] != 0.0 || axis_rates_[1] != 0.0) begin_at(now);
  axis_rates_[0] = axis_rates_[1] = 0.0;
  if (!slew_ && !path_.moving) return;
  slew_.reset();
  parks_ = homes_ = false;
  if (path_.follows)
    path_ = {.follows = true, .base = sky_.star_seen_at(here, now), .stands = {}, .since = now};
  else
    stand_at(here, now);
}

void Telescope::sync_to(const Equatorial& icrs, SimTime now) {
  advance(now);
  need_unparked();
  need_stars();
  if (slew_) refuse("the telescope slews");
  if (!path_.follows) refuse("the telescope does not track");
  const Equatorial pointed = base_at(now);
  offset_ = {std::remainder(icrs.ra_deg - pointed.ra_deg, 360.0), icrs.dec_deg - pointed.dec_deg};
}

void Telescope::set_tracking(bool on, SimTime now) {
  if (advance(now); on == path_.follows) return;
  need_rest(now);
  if (slew_) refuse("the telescope slews");
  const Vec<Enu> here = direction(now);
  if (on)
    path_ = {.follows = true, .base = sky_.star_seen_at(here, now), .stands = {}, .since = now};
  else
    stand_at(here, now);
  homes_ = homes_ && !on;
}

void Telescope::set_rates(double ra_deg_per_s, double dec_deg_per_s, SimTime now) {
  advance(now);
  if (!(std::abs(ra_deg_per_s) <= 1.0 && std::abs(dec_deg_per_s) <= 1.0))
    refuse_value("a rate of tracking must be within 1 deg/s");
  if (ra_deg_per_s == ra_rate_ && dec_deg_per_s == dec_rate_) return;
  need_stars();
  if (now < held_until_ && path_.follows) need_rest(now);
  if (path_.follows) begin_at(now);
  ra_rate_ = ra_deg_per_s;
  dec_rate_ = dec_deg_per_s;
}

void Telescope::move_axis(int axis, double rate_deg_per_s, SimTime now) {
  if (axis != 0 && axis != 1) refuse_value("the telescope has the axes 0 and 1");
  if (!(std::abs(rate_deg_per_s) <= settings_.slew_rate_deg_per_s))
    refuse_value("an axis moves by up to " + std::to_string(settings_.slew_rate_deg_per_s) +
                 " deg/s");
  need_rest(now);
  need_stars();
  if (slew_) refuse("the telescope slews");
  begin_at(now);
  axis_rates_[axis] = rate_deg_per_s;
  homes_ = homes_ && rate_deg_per_s == 0.0;
}

void Telescope::pulse_guide(GuideDirection direction, SimTime length, SimTime now) {
  if (length.ns < 0 || length > max_pulse) refuse_value("a pulse lasts 0 to 60000 ms");
  need_rest(now);
  need_stars();
  if (slew_ || axis_rates_[0] != 0.0 || axis_rates_[1] != 0.0) refuse("the telescope slews");
  if (!path_.follows) refuse("the telescope does not track");
  const int axis = direction == GuideDirection::east || direction == GuideDirection::west ? 0 : 1;
  if (pulses_[axis]) refuse("a pulse along this axis is under way");
  const bool more = direction == GuideDirection::north || direction == GuideDirection::east;
  const double rate = axis == 0 ? ra_guide_ : dec_guide_;
  pulses_[axis] = Pulse{now, now + length, more ? rate : -rate};
}

void Telescope::set_guide_rates(double ra_deg_per_s, double dec_deg_per_s, SimTime now) {
  advance(now);
  for (const double rate : {ra_deg_per_s, dec_deg_per_s})
    if (!(rate > 0.0 && rate <= 1.0)) refuse_value("a guide rate must be > 0 and up to 1 deg/s");
  ra_guide_ = ra_deg_per_s;
  dec_guide_ = dec_deg_per_s;
}

void Telescope::park(SimTime now) {
  if (advance(now); parks_) return;
  need_rest(now);
  const Vec<Enu> from = direction(now);
  axis_rates_[0] = axis_rates_[1] = 0.0;
  stand_at(park_, now);
  begin_slew(from, now);
  parks_ = true;
}

void Telescope::unpark(SimTime now) {
  advance(now);
  if (parks_ && slew_) refuse("the telescope is on its way to its park position");
  parks_ = false;
}

void Telescope::set_park(SimTime now) {
  need_rest(now);
  if (slew_) refuse("the telescope slews");
  park_ = direction(now);
}

void Telescope::find_home(SimTime now) {
  need_rest(now);
  const Vec<Enu> from = direction(now);
  axis_rates_[0] = axis_rates_[1] = 0.0;
  stand_at(home(), now);
  begin_slew(from, now);
  homes_ = true;
}

void Telescope::set_settle_s(double settle_s) {
  if (!(settle_s >= 0.0 && settle_s <= 100.0)) refuse_value("must be 0 to 100 s");
  settings_.settle_s = settle_s;
}

bool Telescope::is_slewing(SimTime now) {
  advance(now);
  return slew_ || axis_rates_[0] != 0.0 || axis_rates_[1] != 0.0;
}

bool Telescope::is_tracking(SimTime now) {
  advance(now);
  return path_.follows;
}

bool Telescope::is_parked(SimTime now) {
  advance(now);
  return parks_ && !slew_;
}

bool Telescope::is_at_home(SimTime now) {
  advance(now);
  return homes_ && !slew_;
}

bool Telescope::is_pulse_guiding(SimTime now) {
  advance(now);
  return pulses_[0] || pulses_[1];
}

bool Telescope::is_pulse_guiding(int axis, SimTime now) {
  advance(now);
  return pulses_[axis].has_value();
}

bool Telescope::is_parking(SimTime now) {
  advance(now);
  return parks_ && slew_;
}

Equatorial Telescope::place(SimTime now) {
  advance(now);
  const Equatorial pointed = path_.follows && !path_.moving && !slew_
                                 ? base_at(now)
                                 : sky_.star_seen_at(direction(now), now);
  return moved(pointed, offset_.ra_deg, offset_.dec_deg);
}

Horizontal Telescope::horizontal_place(SimTime now) {
  advance(now);
  return horizontal(direction(now));
}

PierSide Telescope::side(SimTime now) {
  advance(now);
  return side_;
}

PierSide Telescope::destination_side(const Equatorial& icrs, SimTime now) {
  advance(now);
  return side_of(sky_.seen(moved(icrs, -offset_.ra_deg, -offset_.dec_deg), now));
}

/// The roll by azimuth and elevation of an image whose up is `roll_deg` from north.
double Telescope::north_roll_deg(const Vec<Enu>& d) const {
  const Horizontal h = horizontal(d);
  const Vec<Enu> pole = pole_of(settings_.latitude_deg);
  const double se = std::sin(h.elevation_rad), ce = std::cos(h.elevation_rad);
  const double sa = std::sin(h.azimuth_rad), ca = std::cos(h.azimuth_rad);
  const Vec<Enu> to_zenith{-se * sa, -se * ca, ce}, along_azimuth{ca, -sa, 0.0};
  return std::atan2(dot(pole, along_azimuth), dot(pole, to_zenith)) / deg - settings_.roll_deg;
}

CommandedPointing Telescope::pointing_during(SimTime now, SimTime end) {
  if (is_slewing(now)) refuse("the telescope slews, which no frame shows");
  if (is_pulse_guiding(now)) refuse("the telescope is guided, which no frame shows");
  if (!path_.follows) return standing_at(path_.stands);
  if (elevation_deg(on_path(end)) < settings_.min_elevation_deg)
    refuse("the telescope reaches its least elevation before the exposure ends");
  CommandedPointing p = along_path(now, end);
  p.roll_deg = settings_.roll_deg + flip_deg();
  return p;
}

Vec<Enu> Telescope::axis(SimTime now) {
  advance(now);
  return direction(now);
}

CommandedPointing Telescope::standing_at(const Vec<Enu>& axis) const {
  const Horizontal h = horizontal(axis);
  return {.follows = false,
          .longitude_deg = std::min(h.azimuth_rad / deg, 360.0),
          .latitude_deg = h.elevation_rad / deg,
          .roll_deg = north_roll_deg(axis) + flip_deg()};
}

/// The pointing at what moves among the stars, with the mean rates of the exposure.
CommandedPointing Telescope::along_path(SimTime now, SimTime end) const {
  const auto axis_at = [&](SimTime t) { return equatorial_of(sky_.gcrs(on_path(t), t)); };
  const SimTime middle{now.ns + (end.ns - now.ns) / 2};
  const Equatorial axis = axis_at(middle);
  CommandedPointing p{.follows = true,
                      .longitude_deg = axis.ra_deg,
                      .latitude_deg = axis.dec_deg,
                      .longitude_rate_deg_per_s = ra_rate_,
                      .latitude_rate_deg_per_s = dec_rate_,
                      .reference = middle};
  if (!path_.moving) return p;
  const Equatorial first = axis_at(now), last = axis_at(end);
  const double t_s = (end - now).seconds();
  p.longitude_rate_deg_per_s = std::remainder(last.ra_deg - first.ra_deg, 360.0) / t_s;
  p.latitude_rate_deg_per_s = (last.dec_deg - first.dec_deg) / t_s;
  if (!(std::abs(p.longitude_rate_deg_per_s) <= max_rate_deg_per_s))
    refuse("the satellite moves by more than 10 deg/s of right ascension");
  return p;
}

}  // namespace dmise
