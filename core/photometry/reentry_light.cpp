#include "core/photometry/reentry_light.h"

#include <algorithm>
#include <cmath>

#include "core/photometry/magnitude.h"

namespace dmise {

double ReentryLight::at(double height) const {
  if (!(height >= height_m.front() && height <= height_m.back())) return 0.0;
  const auto above = std::ranges::upper_bound(height_m, height);
  const auto next = std::size_t(std::min(above, height_m.end() - 1) - height_m.begin());
  const double part = (height - height_m[next - 1]) / (height_m[next] - height_m[next - 1]);
  return light_of_magnitude(std::lerp(v_mag[next - 1], v_mag[next], part));
}

}  // namespace dmise
