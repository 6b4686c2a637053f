#pragma once
#include <algorithm>
#include <cmath>

#include "core/photometry/star_spectrum.h"

namespace dmise {

/// Nodes of a table over a star's B-V and the airmass: even in B-V, and in sqrt(X), which follows
/// the bend near X = 0. Values are stored by colour, then by airmass.
struct ColourAirmassNodes {
  static constexpr double max_airmass = 40.0;

  int colours, airmasses;  // at least 2 each

  double airmass(int i) const {
    const double t = double(i) / (airmasses - 1);
    return max_airmass * t * t;
  }
  double bv(int i) const { return min_bv + i * (greatest_bv - min_bv) / (colours - 1); }

  /// The nodes at or below a place, which is held within the table, and the weights of the next
  /// ones.
  struct Place {
    int colour, airmass;
    double to_next_colour, to_next_airmass;
  };
  Place place(double airmass_of_place, double bv_of_place) const {
    const double x = std::clamp(airmass_of_place, 0.0, max_airmass);
    const int a = std::min(int(std::sqrt(x / max_airmass) * (airmasses - 1)), airmasses - 2);
    const double x0 = airmass(a), x1 = airmass(a + 1);
    const double used = bv_of_place >= min_bv ? std::min(bv_of_place, greatest_bv) : min_bv;
    const double c = (used - min_bv) / (greatest_bv - min_bv) * (colours - 1);
    const int row = std::min(int(c), colours - 2);
    return {row, a, c - row, (x - x0) / (x1 - x0)};
  }

  /// `value(colour, airmass)` at the four nodes about a place, bilinear between.
  template <class Value>
  static double between(const Place& at, const Value& value) {
    const auto along = [&](int colour) {
      const double low = value(colour, at.airmass);
      return low + at.to_next_airmass * (value(colour, at.airmass + 1) - low);
    };
    const double here = along(at.colour);
    return here + at.to_next_colour * (along(at.colour + 1) - here);
  }
};

}  // namespace dmise
