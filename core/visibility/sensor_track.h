#pragma once
#include <optional>

#include "core/config/scenario.h"
#include "core/optics/exclusion.h"
#include "core/orbit/sgp4/sgp4_batch.h"
#include "core/sky/air/refraction.h"
#include "core/sky/bodies/occultation.h"
#include "core/visibility/ephemeris_table.h"
#include "core/visibility/pointing.h"

namespace dmise {

/// Position and attitude of a camera at one instant, in the frame of SGP4's states.
struct CameraMoment {
  SimTime time;
  Utc utc;
  bool there = true;  // false if the platform, or the target, has no state
  Vec<Teme> apex_m;
  Rotation<CameraFrame, Teme> camera_from_teme;
  Vec<Teme> up;                         // unit: zenith of a ground site; 0 in orbit
  std::optional<FreeSight> sight;       // in orbit
  Rotation<Gcrs, Teme> gcrs_from_teme;  // in orbit
  Excluded excluded;                    // bodies nearer to the axis than the camera allows

  Vec<CameraFrame> from_camera_m(const Vec<Teme>& position_m) const {
    return camera_from_teme * (position_m - apex_m);
  }
};

/// Position and attitude of a sensor over time, aimed at every instant: a pointing at the zenith or
/// by azimuth and elevation rotates with the Earth, one at the sky or a target follows it.
class SensorTrack {
 public:
  /// `platform` and `target` are objects of `batch`, if the sensor has them. The arguments must
  /// outlive the track.
  SensorTrack(const SensorConfig& sensor, const EphemerisTable& sky, const Sgp4Batch& batch,
              std::optional<std::size_t> platform, std::optional<std::size_t> target);

  const SensorConfig& sensor() const { return sensor_; }
  const EphemerisTable& sky() const { return sky_; }
  const std::optional<Site>& site() const { return site_; }
  /// The object that carries the sensor, which does not see itself.
  std::optional<std::size_t> platform() const { return platform_; }
  /// Whether the camera is fixed to the rotating Earth.
  bool fixed_to_earth() const { return fixed_.has_value(); }
  /// Whether its axes are fixed relative to the stars.
  bool fixed_to_stars() const;

  CameraMoment at(SimTime t) const;

 private:
  CameraMoment camera_at(SimTime t) const;
  /// By straight lines, without refraction.
  Excluded excluded_at(const CameraMoment& now) const;
  std::optional<ObserverState> state_of(std::size_t object, const CameraMoment& now,
                                        const Rotation<Gcrs, Teme>& gcrs_from_teme) const;

  const SensorConfig& sensor_;
  const EphemerisTable& sky_;
  const Sgp4Batch& batch_;
  std::optional<std::size_t> platform_, target_;
  std::optional<Site> site_;
  Vec<Itrs> site_m_, up_;
  bool geometric_ = false;  // points along the straight line to its target
  Refraction refraction_;
  std::optional<Rotation<CameraFrame, Itrs>> fixed_;
};

}  // namespace dmise
