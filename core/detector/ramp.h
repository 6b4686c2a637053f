#pragma once
#include <vector>

#include "core/detector/cosmic_rays.h"
#include "core/detector/noise/detector_effect.h"

namespace dmise {

/// Reads of an infrared detector up the ramp of its charge: n of them, evenly from the reset to the
/// end of the exposure. The signal is the slope of a line through them by least squares, or, with
/// Fowler sampling, the mean of the last reads less that of the first ones; times the exposure.
/// Each read has the read noise. Reads of one ramp share the noise of the reset, which cancels in
/// a difference of reads, but not in a single read. Electrons come at uniform times, so that a
/// ramp's reads are not independent: a fit has more shot noise than the last read. A cosmic ray is
/// a jump at its time.
struct Ramp {
  static constexpr EffectFacts facts{
      "ramp", "the signal is fitted to many reads up the ramp of charge",
      "one read noise; shot noise smaller by up to 10 %",
      "Garnett & Forrest 1993, Proc. SPIE 1946, 395; Rauscher et al. 2007, PASP 119, 768"};
  int ramp_reads = 0;          // 0: none, read noise as it is given
  int fowler_reads = 0;        // at either end; 0: a line by least squares
  double reset_noise_e = 0.0;  // rms (kTC)
  bool operator==(const Ramp&) const = default;

  static std::span<const ParameterOf<Ramp>> parameters();
  static std::optional<DetectorFault> fault(const Detector& detector);
  void switch_off() { ramp_reads = 0; }
  bool applies(const Detector&) const { return ramp_reads > 0; }
  struct Prepared {
    std::vector<double> weights;  // for charge that comes between two reads; their mean is 1
    double variance = 0.0;        // mean square of the weights less 1
    std::vector<CosmicCharge> jumps;
  };
  Prepared prepare(const ExposureFacts& exposed) const;
  void apply(const ExposureFacts& exposed, const Prepared& fit, Piece& piece) const;
  static ErrorBound error(int, const PlanFacts&) { return not_bounded; }
  static double cost_s(int level, const PlanFacts& f);

  /// Returns the read noise of the signal, from that of one read.
  double fitted_noise_e(double read_noise_e) const;
  /// Returns the variance of the signal by shot noise, over its electrons.
  double shot_noise2() const;

 private:
  /// By read; their sum is 0.
  std::vector<double> weights_of_reads() const;
  std::vector<double> weights_of_intervals() const;
};

}  // namespace dmise
