#include "core/tracking/maintenance/maintenance_forces.h"

#include <cmath>

#include "core/forces/acceleration.h"

namespace dmise {
namespace {

constexpr ForceSettings derivative_forces{
    .zonals = 4, .drag = true, .radiation = true, .sun_moon = false};

double drag_m_per_s2(const OrbitState& at) {
  const double height_m = norm(at.position_m) - earth_equatorial_radius_m;
  const AirLayer air = air_layer(height_m);
  const double density =
      air.density_kg_per_m3 * std::exp(std::min(0.0, (air.base_m - height_m) / air.scale_m));
  return 0.5 * density * std::fabs(at.drag_m2_per_kg) *
         dot(at.velocity_m_per_s, at.velocity_m_per_s);
}

}  // namespace

MaintenanceForces::MaintenanceForces(const Clock& clock, SimTime first, SimTime last,
                                     const MaintenanceSettings& settings)
    : clock_(clock),
      settings_(settings),
      surroundings_(
          std::make_shared<const EarthSurroundings>(clock, first.seconds(), last.seconds())),
      derivatives_(clock, SimTime{first.ns / 2 + last.ns / 2}, derivative_forces) {}

FlightForces MaintenanceForces::flight(double drag_m2_per_kg, double radiation_m2_per_kg) const {
  return {surroundings_,
          {.gravity_degree = settings_.gravity_degree,
           .sun_moon = true,
           .drag_m2_per_kg = drag_m2_per_kg,
           .radiation_m2_per_kg = radiation_m2_per_kg}};
}

Eigen::Vector3d MaintenanceForces::noise_m_per_s(const OrbitState& at, double duration_s) const {
  const ForceNoise& noise = settings_.noise;
  const double air = noise.drag_share * drag_m_per_s2(at);
  const double light =
      noise.radiation_share * solar_pressure_n_per_m2 * std::fabs(at.srp_m2_per_kg);
  const double all = noise.floor_m2_per_s3 + light * light * noise.radiation_s;
  const Eigen::Vector3d density(all, all + air * air * noise.drag_s, all);
  return (density * duration_s).cwiseSqrt();
}

}  // namespace dmise
