#pragma once
#include <string>

namespace dmise {

/// A top-hat band in wavelength.
struct Band {
  std::string name = "V";
  double centre_m = 0.55e-6;
  double width_m = 0.128e-6;         // full width

  bool operator==(const Band&) const = default;
};

}  // namespace dmise
