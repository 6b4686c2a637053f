#include "core/sky/bodies/limb_extinction.h"

#include <algorithm>
#include <cmath>

#include "core/base/numeric/table_place.h"
#include "core/effects/plan_facts.h"
#include "core/sky/air/grazing_air.h"
#include "core/sky/air/kept_tables.h"
#include "core/sky/air/standard_air.h"

namespace dmise {
namespace {

constexpr double ray_step_m = 500.0;
constexpr std::size_t ray_count = std::size_t(LimbExtinction::top_m / ray_step_m) + 1;
constexpr double darkest_log = -700.0;  // stands for no light

}  // namespace

ErrorBound LimbExtinction::error(int, const PlanFacts& f) {
  return f.scene.limb_in_field ? not_bounded : ErrorBound{};
}

double LimbExtinction::cost_s(int level, const PlanFacts& f) {
  return f.scene.limb_in_field ? level * 100e-9 * (f.stars + f.sky_looks()) : 0.0;
}

struct LimbRays {
  struct Ray {
    double bending_rad;
    /// How much higher than the lowest point of the ray its straight part passes over the ground.
    double lifted_m;
    double log_transmission;
  };
  std::vector<Ray> rays;  // every `ray_step_m`

  LimbRays(const Band& band, double radius_m) {
    const GrazingAir air(band);
    const double refractivity = refractivity_at_sea(band.centre_m);
    for (std::size_t i = 0; i < ray_count; ++i) {
      const double height_m = ray_step_m * double(i);
      rays.push_back(
          {air.bending_rad(height_m),
           refractivity * relative_density(height_m) * (radius_m + height_m),
           std::max(darkest_log, std::log(std::max(1e-300, air.transmission(height_m))))});
    }
    // Above the last ray nothing is lost.
    const Ray last = rays.back();
    for (Ray& ray : rays) {
      ray.bending_rad = std::max(0.0, ray.bending_rad - last.bending_rad);
      ray.lifted_m -= last.lifted_m;
      ray.log_transmission = std::min(0.0, ray.log_transmission - last.log_transmission);
    }
  }

  double transmission(const TablePlace& at) const {
    const double log =
        std::lerp(rays[at.node].log_transmission, rays[at.node + 1].log_transmission, at.part);
    return log > darkest_log ? std::exp(log) : 0.0;
  }
};

LimbExtinction::LimbExtinction(const Band& band, const LimbSight& sight) : sight_(sight) {
  static KeptTables<std::pair<Band, double>, LimbRays> tables;
  const double radius_m = sight.earth().ellipsoid.equatorial_radius_m;
  rays_ = tables.of({band, radius_m}, [&] { return LimbRays(band, radius_m); });
}

double LimbExtinction::of_surface(const LimbLine& line) const {
  const double height_m = line.tangent_height_m();
  if (line.from_m >= 0.0 || height_m >= top_m) return 1.0;
  return rays_->transmission(table_place(height_m / ray_step_m, ray_count));
}

double LimbExtinction::of_point(const Vec<Gcrs>& direction, double distance_m) const {
  const LimbLine line = sight_.line(direction);
  const double height_m = line.tangent_height_m();
  if (line.from_m >= 0.0 || height_m >= top_m) return 1.0;
  const double to_m = -line.from_m, behind_m = distance_m * (1.0 / line.true_scale) - to_m;
  if (behind_m <= 0.0) return 1.0;
  // Lowest height of the straight line between both ends of a ray that is bent.
  const double lever_m = std::isfinite(behind_m) ? to_m * behind_m / (to_m + behind_m) : to_m;
  const auto& rays = rays_->rays;
  const auto straight_m = [&](std::size_t i) {
    return ray_step_m * double(i) + rays[i].lifted_m - lever_m * rays[i].bending_rad;
  };
  // The highest ray from which on all pass higher.
  std::size_t low = 0, high = ray_count - 1;
  if (height_m <= straight_m(0)) return 0.0;
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (straight_m(middle) > height_m ? high : low) = middle;
  }
  const double from_m = straight_m(low), to_next_m = std::max(1.0, straight_m(high) - from_m);
  const double part = std::clamp((height_m - from_m) / to_next_m, 0.0, 1.0);
  const std::size_t below = low > 0 ? low - 1 : 0, above = std::min(high + 1, ray_count - 1);
  const double spread =
      ray_step_m * double(above - below) / std::max(1.0, straight_m(above) - straight_m(below));
  return rays_->transmission({low, part}) * std::min(1.0, spread);
}

}  // namespace dmise
