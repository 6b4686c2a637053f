#include "core/photometry/band_parts.h"

#include <algorithm>

namespace dmise {

std::vector<Band> parts_of(const Band& band, int count) {
  std::vector<Band> parts;
  for (int i = 0; i < count; ++i) {
    const double span = band.high_m() - band.low_m();
    const double low = band.low_m() + span * i / count;
    const double high = band.low_m() + span * (i + 1) / count;
    Band part{band.name, (low + high) / 2, high - low, {}};
    if (!band.response.empty()) {
      Curve& cut = part.response;
      cut.wavelength_m.push_back(low);
      for (const double x : band.response.wavelength_m)
        if (x > low && x < high) cut.wavelength_m.push_back(x);
      cut.wavelength_m.push_back(high);
      for (const double x : cut.wavelength_m) cut.value.push_back(band.response.at_or_zero(x));
      if (std::none_of(cut.value.begin(), cut.value.end(), [](double y) { return y > 0; }))
        continue;
      part = band_of(band.name, std::move(cut));
    }
    parts.push_back(std::move(part));
  }
  return parts;
}

}  // namespace dmise
