#pragma once
#include <vector>

namespace dmise {

/// A quantity tabulated over wavelength, interpolated linearly.
struct Curve {
  std::vector<double> wavelength_m;  // ascending
  std::vector<double> value;

  bool empty() const { return wavelength_m.empty(); }
  void add(double at_m, double value_there) {
    wavelength_m.push_back(at_m);
    value.push_back(value_there);
  }
  /// Linear between samples, the end values outside of them; 1 when empty.
  double at_or_end(double wavelength_m) const;
  /// Linear between samples, 0 outside of them; 1 when empty.
  double at_or_zero(double wavelength_m) const;
  bool operator==(const Curve&) const = default;
};

/// Throws `Error` "NAME: reason" unless wavelengths are positive and ascend and every value is
/// finite and at least 0; an empty curve is fine.
void check_curve(const Curve& curve, const char* name);

}  // namespace dmise
