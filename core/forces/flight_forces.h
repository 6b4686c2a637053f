#pragma once
#include <memory>

#include "core/forces/earth_surroundings.h"
#include "core/forces/gravity_field.h"

namespace dmise {

/// What acts on an object that flies by numerical integration.
struct FlightForceSettings {
  int gravity_degree = 20;  // 0 (a point mass without relativity), or 2 to 70
  bool sun_moon = true;     // their attraction, and the solid tides that they raise in the Earth
  double drag_m2_per_kg = 0.0;       // drag coefficient times area over mass; 0: no drag
  double radiation_m2_per_kg = 0.0;  // radiation pressure coefficient times area over mass
  bool operator==(const FlightForceSettings&) const = default;
};

/// Accelerations of one object. Immutable; may be shared between threads. docs/models/motion.md has
/// sources, accuracy, and what is left out.
class FlightForces {
 public:
  /// Throws `Error` for a degree out of range.
  FlightForces(std::shared_ptr<const EarthSurroundings> surroundings,
               const FlightForceSettings& settings);

  const EarthSurroundings& surroundings() const { return *surroundings_; }

  /// How much sunlight presses on a place: its amount jumps or bends from one to another.
  enum class Sunlight { not_felt, full, penumbra, none };
  Sunlight sunlight(double time_s, const Vec<Gcrs>& position_m) const;

  /// Acceleration [m/s^2] at a simulation time. No light reaches a place inside the Earth.
  Vec<Gcrs> acceleration_m_per_s2(double time_s, const Vec<Gcrs>& position_m,
                                  const Vec<Gcrs>& velocity_m_per_s) const;

 private:
  std::shared_ptr<const EarthSurroundings> surroundings_;
  FlightForceSettings settings_;
  GravityField gravity_;
};

}  // namespace dmise
