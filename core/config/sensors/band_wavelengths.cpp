#include "core/config/sensors/band_wavelengths.h"

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
  return all;
}

}  // namespace dmise
