#include "core/config/sensors/interpolation_choice.h"

#include <algorithm>

#include "core/orbit/interpolation_error.h"

namespace dmise {
namespace {

constexpr double share_of_budget = 0.25;
constexpr double min_range_on_ground_m = 200e3, min_range_in_orbit_m = 10e3;
/// Least budget, in shares of the standard one: some sensors ask for no error at all.
constexpr double min_share = 0.1;

/// Greatest error between ticks that a sensor tolerates [m].
double max_error_m(const SensorConfig& sensor) {
  if (!sensor.accuracy.is_planned()) return unbounded;
  const bool timed = sensor.accuracy.name == "seconds";
  const double budget_px =
      timed ? standard_budget.position_px
            : std::max(sensor.accuracy.budget.position_px, min_share * standard_budget.position_px);
  const double range_m = std::holds_alternative<SiteConfig>(sensor.place) ? min_range_on_ground_m
                                                                          : min_range_in_orbit_m;
  return share_of_budget * budget_px * sensor.camera.optics.pixel_angle_rad() * range_m;
}

}  // namespace

HermiteOrder choose_interpolation(const std::vector<SensorConfig>& sensors, double tick_s) {
  double max_m = unbounded;
  for (const SensorConfig& sensor : sensors) max_m = std::min(max_m, max_error_m(sensor));
  HermiteOrder choice = HermiteOrder::cubic;
  double min_m = unbounded;
  for (const HermiteOrder order :
       {HermiteOrder::cubic, HermiteOrder::quintic, HermiteOrder::septic}) {
    const auto error = stated_interpolation_error(order, tick_s);
    if (!error || tick_s > longest_tick_s(order) * (1.0 + 1e-9)) continue;
    if (error->worst_m < min_m) {
      min_m = error->worst_m;
      choice = order;
    }
    if (min_m <= max_m) break;
  }
  return choice;
}

}  // namespace dmise
