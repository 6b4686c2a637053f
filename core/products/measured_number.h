#pragma once

namespace dmise {

/// A number with its standard deviation.
struct MeasuredNumber {
  double value = 0.0;
  double sigma = 0.0;

  bool operator==(const MeasuredNumber&) const = default;
};

}  // namespace dmise
