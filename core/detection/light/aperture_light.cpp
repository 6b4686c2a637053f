#include "core/detection/light/aperture_light.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/base/numeric/table_place.h"
#include "core/base/units.h"

namespace dmise {
namespace {

constexpr double step = 0.02;  // between radii of the table, in wavelength / diameter

/// 2 J1(v) / v.
double jinc(double v) { return v > 0 ? 2 * std::cyl_bessel_j(1.0, v) / v : 1.0; }

}  // namespace

// Source: Born & Wolf, Principles of Optics, 8.5.2 and 8.6.2: intensity behind a disc and an
// annulus.
ApertureLight::ApertureLight(double obscuration) {
  const double share = obscuration * obscuration, open = 1 - share;
  const auto brightness = [&](double radius) {  // per square; its integral over the plane is 1
    const double v = pi * radius;
    const double amplitude = (jinc(v) - share * jinc(obscuration * v)) / open;
    return pi / 4 * open * amplitude * amplitude;
  };
  const auto size = std::size_t(max_radius / step) + 3;
  double light = 0.0;
  for (std::size_t i = 0; i < size; ++i) {
    const double radius = double(i) * step, middle = radius + step / 2;
    within_.push_back(light);
    brightness_.push_back(brightness(radius));
    light += 2 * pi * middle * step * brightness(middle);
  }
}

double ApertureLight::within(double radius, double variance) const {
  const auto [i, next] = table_place(std::min(radius, max_radius) / step, within_.size());
  // A blur moves light down the slope of the brightness.
  const double slope = (brightness_[i + 1] - brightness_[i]) / step;
  return within_[i] + next * (within_[i + 1] - within_[i]) + pi * radius * variance * slope;
}

}  // namespace dmise
