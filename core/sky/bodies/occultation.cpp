#include "core/sky/bodies/occultation.h"

#include "core/effects/plan_facts.h"

namespace dmise {

ErrorBound EarthOccultation::error(int, const PlanFacts& f) {
  return f.sees_horizon ? not_bounded : ErrorBound{};
}

double EarthOccultation::cost_s(int level, const PlanFacts& f) { return level * 3e-9 * f.stars; }

FreeSight::FreeSight(const Vec<Gcrs>& from_m, const OblateEarth& earth)
    : earth_(earth),
      from_(earth.stretched(from_m)),
      from_squared_(dot(from_, from_)),
      radius_squared_(earth.ellipsoid.equatorial_radius_m * earth.ellipsoid.equatorial_radius_m) {}

// `along`: projection of the stretched place on the line, negative where the line comes down.
bool FreeSight::passes(const Vec<Gcrs>& line, double along) const {
  if (along >= 0.0) return true;
  return from_squared_ - along * along / dot(line, line) >= radius_squared_;
}

bool FreeSight::clear(const Vec<Gcrs>& to_m) const {
  const Vec<Gcrs> to = earth_.stretched(to_m);
  if (dot(to, to) < radius_squared_) return false;
  const Vec<Gcrs> line = to - from_;
  if (dot(line, to) <= 0.0) return true;  // the end is the lowest point, and it is outside
  return passes(line, dot(line, from_));
}

bool FreeSight::clear_direction(const Vec<Gcrs>& direction) const {
  const Vec<Gcrs> line = earth_.stretched(direction);
  return passes(line, dot(line, from_));
}

}  // namespace dmise
