#pragma once
#include <vector>

#include "core/detector/cosmic_rays.h"
#include "core/detector/detector_effect.h"

namespace dmise {

/// Reads of an infrared detector up the ramp of its charge: n of them, evenly from the reset to the
/// end of the exposure. The signal is the slope of a line through them by least squares, or by
/// Fowler's way the mean of the last reads less that of the first ones; times the exposure. Each
/// read has the read noise, and reads of one ramp have the same noise of the reset, which a
/// difference has not: a single read has it. Electrons come at uniform times, so that reads of a
/// ramp are not independent: a fit has more shot noise than the last read. A cosmic ray is a jump
/// at a time of its own.
struct Ramp {
  static constexpr EffectFacts facts{
      "ramp", "the signal is fitted to many reads up the ramp of charge",
      "one read noise; shot noise smaller by up to 10 %",
      "Garnett & Forrest 1993, Proc. SPIE 1946, 395; Rauscher et al. 2007, PASP 119, 768"};
  int ramp_reads = 0;          // 0: none, read noise as it is given
  int fowler_reads = 0;        // at either end; 0: a line by least squares
  double reset_noise_e = 0.0;  // rms (kTC)
  bool operator==(const Ramp&) const = default;

  static std::span<const DetectorParameter> parameters();
  static std::optional<DetectorFault> fault(const Detector& detector);
  void switch_off() { ramp_reads = 0; }
  bool applies(const Detector&) const { return ramp_reads > 0; }
  struct Prepared {
    std::vector<double> weights;  // of charge that comes between two reads; their mean is 1
    double variance = 0.0;        // of the weights
    std::vector<CosmicCharge> jumps;
  };
  Prepared prepare(const ExposureFacts& exposed) const;
  void apply(const ExposureFacts& exposed, const Prepared& fit, Piece& piece) const;
  static ErrorBound error(int, const PlanFacts&) { return not_bounded; }
  static double cost_s(int level, const PlanFacts& f) { return level * 15e-9 * f.pixels(); }

  /// Read noise of the signal, by that of one read.
  double fitted_noise_e(double read_noise_e) const;
  /// Variance of the signal by shot noise, over its electrons.
  double shot_noise2() const;

 private:
  /// By read; their sum is 0.
  std::vector<double> weights_of_reads() const;
  std::vector<double> weights_of_intervals() const;
};

}  // namespace dmise
