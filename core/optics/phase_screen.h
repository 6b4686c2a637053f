#pragma once
#include <array>
#include <vector>

#include "core/base/rng.h"
#include "core/optics/fft.h"

namespace dmise {

/// Phase of a wavefront on a square grid [rad], row-major, side x side.
struct PhaseScreen {
  int side = 0;
  std::vector<float> phase_rad;

  float at(int x, int y) const {
    return phase_rad[std::size_t(y) * std::size_t(side) + std::size_t(x)];
  }
};

/// Draws Kolmogorov screens whose expected structure function is 6.88 (r / r0)^(5/3) at every
/// separation from one sample to the screen's side, with neither sub-harmonics nor an outer scale:
/// circulant embedding of a locally equal stationary field plus a random tilt. Source: Stein 2002,
/// J. Comput. Graph. Stat. 11, 587 (exponent 5/3, cut-off radius 2). Costs one complex transform of
/// (5.7 side)^2 for two screens.
class KolmogorovScreens {
 public:
  /// `side` 2..1024 samples.
  explicit KolmogorovScreens(int side);

  int side() const { return side_; }

  /// Two independent screens. `draw` counts pairs of one key, from 0; r0 in samples.
  std::array<PhaseScreen, 2> draw(const RngKey& key, std::uint32_t draw, double r0_samples);

  /// The expected structure function of what `draw` makes, computed from the amplitudes it uses, at
  /// a separation of dx, dy samples (|dx|, |dy| < side) for r0 of one sample [rad2].
  double expected_structure(int dx, int dy) const;

 private:
  int side_, torus_;
  double unit_;                   // samples in the unit of length of the covariance
  std::vector<float> amplitude_;  // quarter of the torus' spectrum, (torus / 2 + 1)^2
  ComplexFft2 fft_;
  FftBuffer field_;
};

/// 6.88 (r / r0)^(5/3) [rad2].
double kolmogorov_structure(double separation, double r0);

}  // namespace dmise
