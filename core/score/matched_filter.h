#pragma once

namespace dmise {

/// What the ideal detector knows of a source: a uniform trail of `length_px` (0: a point), blurred
/// by a Gaussian and the pixels, on noise that is the same in every pixel.
struct IdealSource {
  double signal_e = 0.0;
  double length_px = 0.0;
  double noise_e = 0.0;   // per pixel, without the source's own
  double sigma_px = 0.0;  // Gaussian PSF, before pixel integration
};

/// SNR of the matched filter, limited by the background: signal_e / noise_e times the root of the
/// integral of the squared template [1/px2]. Pixels widen the Gaussian by 1/12 px2.
double matched_filter_snr(const IdealSource& source);

/// Cramer-Rao bound of the position across the trail (of a point: along any axis) [px], with the
/// source's own photon noise: exact where the background or the source's noise prevails.
double position_bound_px(const IdealSource& source);

/// Probability that the matched filter's output exceeds the threshold: Q(threshold - snr).
double theory_of_detection(double snr, double threshold_snr);

}  // namespace dmise
