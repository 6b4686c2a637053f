#pragma once
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/orbit/elements/elements.h"
#include "core/orbit/motion_state.h"
#include "core/orbit/oem.h"
#include "core/time/clock.h"
#include "core/tracking/orbit_state.h"

namespace dmise {

/// A satellite of the reference data whose precise orbit, element sets and manoeuvres are known.
class KnownSatellite {
 public:
  /// "sentinel3a" or "jason1"; `data` is the reference data's root, `start` the clock's UTC.
  KnownSatellite(const std::string& data, const std::string& name, const std::string& start);

  const Clock& clock() const { return clock_; }
  /// In GCRS, by the precise orbit.
  MotionState<Gcrs> truth(SimTime time) const;
  /// The newest element set that is `age_days` old or more at a time.
  MeanElements elements(SimTime time, double age_days) const;
  double radius_m() const { return radius_m_; }

 private:
  Clock clock_;
  Trajectory orbit_;
  std::vector<MeanElements> elements_;
  double radius_m_ = 0.0;  // sphere that is as bright
};

/// A manoeuvre that the operator has logged, and its size by the element sets around it.
struct LoggedManoeuvre {
  std::string utc;
  double transverse_m_per_s = 0.0;  // by the change of the semi-major axis
  double normal_m_per_s = 0.0;      // by that of the orbit's plane
};

/// Manoeuvres of "Sentinel-3A", "Jason-1" or "CryoSat-2" of the reference data.
std::vector<LoggedManoeuvre> logged_manoeuvres(const std::string& data, const std::string& name);

/// Where an element set says that an object is, as a prior with the fusion's default errors, and
/// with scales of drag and sunlight that are hardly known.
OrbitEstimate believed(const MeanElements& elements, const Clock& clock, SimTime time);

}  // namespace dmise
