#pragma once
#include <functional>
#include <optional>

#include "sensors/observatory/commanded_exposure.h"
#include "sensors/observatory/device_error.h"
#include "sensors/observatory/site_sky.h"

namespace dmise {

inline constexpr double sidereal_deg_per_s = 360.0 / 86164.0905;  // turn of the stars

struct TelescopeSettings {
  double latitude_deg = 0.0;         // geodetic, of the site
  double slew_rate_deg_per_s = 3.0;  // > 0, along a great circle
  double settle_s = 1.0;             // after a slew
  double min_elevation_deg = 0.0;    // below it the telescope does not go
  double roll_deg = 0.0;             // up of the image, from north towards east
};

/// Numbers are those of ASCOM's PierSide.
enum class PierSide { east = 0, west = 1 };
/// Numbers are those of ASCOM's GuideDirections.
enum class GuideDirection { north = 0, south = 1, east = 2, west = 3 };

/// An equatorial telescope on a German mount as its commands move it: a state machine over the time
/// that each call is given, which must not decrease. Its axis is where its control puts it; errors
/// of pointing are the camera's. Calls throw `DeviceError`.
class Telescope {
 public:
  /// It stands at its home: on the meridian, at the elevation of the pole. `sky` must outlive it.
  Telescope(const TelescopeSettings& settings, const SiteSky& sky);

  void slew_to(const Equatorial& icrs, SimTime now);   // needs tracking
  void slew_to(const Horizontal& place, SimTime now);  // needs that it does not track
  /// Goes to `icrs` whether it tracks or not; there it tracks, or stands where the place then is.
  void go_to(const Equatorial& icrs, bool then_tracks, SimTime now);
  /// Goes to what moves over the sky, and stays with it until it is told otherwise; `path` is where
  /// it is seen.
  void follow(std::function<Vec<Enu>(SimTime)> path, SimTime now);
  bool is_following() const { return bool(path_.moving); }
  /// Ends slews, motions of the axes and the following of a satellite; it stays with the stars if
  /// it tracks.
  void abort_slew(SimTime now);
  /// Says that it points at `icrs`: places that it is told and tells differ by that from now on.
  void sync_to(const Equatorial& icrs, SimTime now);
  void set_tracking(bool on, SimTime now);
  /// Motion among the stars while it tracks [deg/s]: of right ascension, of declination.
  void set_rates(double ra_deg_per_s, double dec_deg_per_s, SimTime now);
  /// Turns an axis, 0: right ascension, 1: declination, until the rate is 0 [deg/s].
  void move_axis(int axis, double rate_deg_per_s, SimTime now);
  void pulse_guide(GuideDirection direction, SimTime length, SimTime now);
  /// [deg/s], (0, 1].
  void set_guide_rates(double ra_deg_per_s, double dec_deg_per_s, SimTime now);
  void park(SimTime now);
  void unpark(SimTime now);
  void set_park(SimTime now);
  void find_home(SimTime now);
  void set_settle_s(double settle_s);  // [0, 100]

  bool is_slewing(SimTime now);  // also while an axis is moved
  bool is_tracking(SimTime now);
  bool is_parked(SimTime now);
  bool is_at_home(SimTime now);
  bool is_pulse_guiding(SimTime now);
  bool is_pulse_guiding(int axis, SimTime now);  // as of `move_axis`
  bool is_parking(SimTime now);                  // on its way
  Equatorial place(SimTime now);                 // with what `sync_to` said
  Horizontal horizontal_place(SimTime now);
  PierSide side(SimTime now);
  PierSide destination_side(const Equatorial& icrs, SimTime now);
  double ra_rate_deg_per_s() const { return ra_rate_; }
  double dec_rate_deg_per_s() const { return dec_rate_; }
  double axis_rate_deg_per_s(int axis) const { return axis_rates_[axis]; }  // set by `move_axis`
  double ra_guide_rate_deg_per_s() const { return ra_guide_; }
  double dec_guide_rate_deg_per_s() const { return dec_guide_; }
  const TelescopeSettings& settings() const { return settings_; }

  /// Where a camera points during an exposure that begins now. Refuses while it slews, guides, or
  /// if it would reach the least elevation.
  CommandedPointing pointing_during(SimTime now, SimTime end);
  /// Where the axis is.
  Vec<Enu> axis(SimTime now);
  /// Where a camera points whose telescope stands still.
  CommandedPointing standing_at(const Vec<Enu>& axis) const;
  /// A shutter is open until `end`: what moves the telescope otherwise is refused until then.
  void hold_until(SimTime end) { held_until_ = end; }

 private:
  /// Where the axis goes when no slew is under way.
  struct Path {
    bool follows = false;  // the stars, or what moves among them
    Equatorial base;       // at `since`, ICRS
    Vec<Enu> stands{0.0, 1.0, 0.0};
    SimTime since;
    std::function<Vec<Enu>(SimTime)> moving = {};  // empty: it follows the stars
  };
  struct Slew {
    Vec<Enu> from;
    SimTime start, arrival, end;  // motion from start to arrival; the end is after settling
    bool then_stands = false;     // where the path is at its end
  };
  struct Pulse {
    SimTime start, end;
    double rate_deg_per_s = 0.0;
  };

  void advance(SimTime now);
  void need_rest(SimTime now);  // neither parked, nor a shutter open
  void need_unparked() const;
  void need_stars() const;  // not something that moves among them
  CommandedPointing along_path(SimTime now, SimTime end) const;
  Equatorial base_at(SimTime t) const;
  Vec<Enu> on_path(SimTime t) const;
  Vec<Enu> direction(SimTime t) const;
  void begin_at(SimTime t);  // the path anew from where it is
  void stand_at(const Vec<Enu>& direction, SimTime now);
  void begin_slew(const Vec<Enu>& from, SimTime now);
  void need_elevation(const Vec<Enu>& direction) const;
  PierSide side_of(const Vec<Enu>& direction) const;
  Vec<Enu> home() const;
  double flip_deg() const { return side_ == PierSide::west ? 180.0 : 0.0; }  // through the pole
  double north_roll_deg(const Vec<Enu>& direction) const;

  TelescopeSettings settings_;
  const SiteSky& sky_;
  Path path_;
  std::optional<Slew> slew_;
  std::optional<Pulse> pulses_[2];
  double axis_rates_[2] = {0.0, 0.0};
  double ra_rate_ = 0.0, dec_rate_ = 0.0;
  double ra_guide_, dec_guide_;
  Equatorial offset_{0.0, 0.0};  // told minus pointed
  Vec<Enu> park_;
  bool parks_ = false, homes_ = true;  // at the end of the slew
  PierSide side_ = PierSide::east;
  SimTime held_until_;
};

}  // namespace dmise
