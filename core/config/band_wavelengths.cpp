#include "core/config/band_wavelengths.h"

#include <algorithm>
#include <cmath>

namespace dmise {

std::vector<WavelengthShare> wavelengths_of(const Band& band, int count) {
  if (count == 1) return {{band.centre_m, 1.0}};
  std::vector<WavelengthShare> all;
  double sum = 0.0;
  for (int i = 0; i < count; ++i) {
    const double at = band.low_m() + (band.high_m() - band.low_m()) * (i + 0.5) / count;
    const double share = band.response.at_or_zero(at);
    if (share <= 0.0) continue;
    all.push_back({at, share});
    sum += share;
  }
  for (WavelengthShare& w : all) w.share /= sum;
  // The one closest to the centre first: screens are sampled for it.
  const auto middle = std::min_element(all.begin(), all.end(), [&](const auto& a, const auto& b) {
    return std::abs(a.wavelength_m - band.centre_m) < std::abs(b.wavelength_m - band.centre_m);
  });
  std::iter_swap(all.begin(), middle);
  return all;
}

}  // namespace dmise
