#pragma once
#include <span>
#include <vector>

namespace dmise {

/// Probability that the chain detects a source in a frame, by the SNR of the ideal matched filter
/// (`matched_filter_snr`) and the length of its trail: share x Q(ln(half / SNR) / spread). Between
/// lengths `half` and `spread` are interpolated in log2(1 + length), beyond them they are those of
/// the ends.
struct DetectionModel {
  struct Length {
    double length_px = 0.0;
    double half_snr = 6.0;  // at which half of what nothing hides is found
    double spread = 0.15;   // of its logarithm, > 0

    bool operator==(const Length&) const = default;
  };
  std::vector<Length> lengths;  // ascending, at least one
  double share = 1.0;           // of bright sources that are found, (0, 1]

  bool operator==(const DetectionModel&) const = default;
};

/// The model with what was measured in rendered frames (docs/models/survey.md).
const DetectionModel& measured_detection_model();

/// Returns a probability in [0, 1) for any SNR >= 0 and length >= 0.
double detection_probability(const DetectionModel& model, double snr, double length_px);

/// Less is taken for 0.
inline constexpr double least_probability = 1e-6;

/// A source of a rendered frame.
struct DetectionSample {
  double snr = 0.0, length_px = 0.0;
  bool found = false;
};

/// Fits `half_snr`, `spread` and `share` of a model with the lengths of `start` to samples by
/// maximum likelihood. A weak prior keeps what samples do not tell as it is in `start`. The result
/// does not depend on the order of samples of equal values.
DetectionModel fitted_detection_model(const DetectionModel& start,
                                      std::span<const DetectionSample> samples);

}  // namespace dmise
