#include "core/photometry/curve.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/error.h"

namespace dmise {

double Curve::at_or_end(double x) const {
  if (empty()) return 1.0;
  if (x <= wavelength_m.front()) return value.front();
  if (x >= wavelength_m.back()) return value.back();
  const auto above = std::upper_bound(wavelength_m.begin(), wavelength_m.end(), x);
  const auto i = std::size_t(above - wavelength_m.begin());
  const double t = (x - wavelength_m[i - 1]) / (wavelength_m[i] - wavelength_m[i - 1]);
  return value[i - 1] + t * (value[i] - value[i - 1]);
}

double Curve::at_or_zero(double x) const {
  if (!empty() && (x < wavelength_m.front() || x > wavelength_m.back())) return 0.0;
  return at_or_end(x);
}

void check_curve(const Curve& curve, const char* name) {
  const auto fail = [&](const char* why) { throw Error(std::string(name) + ": " + why); };
  if (curve.wavelength_m.size() != curve.value.size())
    fail("must have as many values as wavelengths");
  double last = 0.0;
  for (const double x : curve.wavelength_m) {
    if (!(x > last) || !std::isfinite(x)) fail("wavelengths must be > 0 and ascend");
    last = x;
  }
  for (const double y : curve.value)
    if (!(y >= 0) || !std::isfinite(y)) fail("values must be finite and >= 0");
}

}  // namespace dmise
