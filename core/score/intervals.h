#pragma once
#include <cstddef>
#include <optional>
#include <span>

namespace dmise {

struct Interval {
  double low = 0.0, high = 0.0;
};

/// 95 % interval of a probability after `successes` of `trials`; [0, 1] without trials. Source:
/// Wilson 1927, JASA 22, 209.
Interval wilson_interval(std::size_t successes, std::size_t trials);

/// Interval that holds the mean of `count` squared normalised errors of two dimensions each,
/// divided by two, with 95 % probability if the covariances are honest; `count` > 0.
Interval nees_interval(std::size_t count);

struct DetectionTrial {
  double snr = 0.0;
  bool found = false;
};

/// The threshold at which Q(threshold - SNR) fits trials best (maximum likelihood); empty if they
/// don't bracket it: all found, or none.
std::optional<double> fitted_threshold(std::span<const DetectionTrial> trials);

}  // namespace dmise
