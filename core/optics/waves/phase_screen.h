#pragma once
#include <array>
#include <limits>
#include <vector>

#include "core/base/numeric/rng.h"
#include "core/optics/waves/fft.h"

namespace dmise {

/// Wavefront phase on a square grid [rad], row-major, side x side.
struct PhaseScreen {
  int side = 0;
  std::vector<float> phase_rad;

  float at(int x, int y) const {
    return phase_rad[std::size_t(y) * std::size_t(side) + std::size_t(x)];
  }
};

/// Draws Kolmogorov screens whose expected structure function is 6.88 (r / r0)^(5/3) at every
/// separation from one sample to the screen's side, without sub-harmonics or an outer scale:
/// circulant embedding of a locally equal stationary field plus a random tilt. Source: Stein 2002,
/// J. Comput. Graph. Stat. 11, 587 (exponent 5/3, cut-off radius 2). Costs one complex transform of
/// size (5.7 side)^2 per two screens.
///
/// With an outer scale (von Karman) the spectrum is multiplied by (k^2 / (k^2 + 1 / L0^2))^(11/6)
/// and the tilt reduced to match the structure function at a third of the side: within 3 % from
/// four samples to there.
class KolmogorovScreens {
 public:
  /// `side` 2..1024 samples; the outer scale in samples, infinite for Kolmogorov's spectrum.
  explicit KolmogorovScreens(int side,
                             double outer_scale = std::numeric_limits<double>::infinity());

  int side() const { return side_; }
  int torus() const { return torus_; }

  /// Draws two independent fields of the whole torus (torus x torus, periodic) without their tilt,
  /// for r0 of one sample, into `first` and `second`, and returns the tilts in radians per sample
  /// along x and y. `draw` counts the pairs of one key, from 0.
  struct Tilt {
    double x = 0.0, y = 0.0;
  };
  std::array<Tilt, 2> draw_fields(const RngKey& key, std::uint32_t draw, std::vector<float>& first,
                                  std::vector<float>& second);

  /// The expected structure function of fields with their tilt, computed from the amplitudes, at a
  /// separation of dx, dy samples (|dx|, |dy| < side) for r0 of one sample [rad2].
  double expected_structure(int dx, int dy) const;

 private:
  void transform_noise(const RngKey& key, std::uint32_t draw);
  Tilt tilt(const RngKey& key, std::uint32_t draw, std::uint32_t part) const;

  int side_, torus_;
  double unit_;                   // samples per unit of length of the covariance
  double tilt_ = 0.0;             // its rms per sample, in units of the field's
  std::vector<float> amplitude_;  // quarter of the torus' spectrum, (torus / 2 + 1)^2
  ComplexFft2 fft_;
  FftBuffer field_;
};

/// 6.88 (r / r0)^(5/3) [rad2].
double kolmogorov_structure(double separation, double r0);

/// Von Karman's, all lengths in one unit; Kolmogorov's if the outer scale is infinite. The Hankel
/// transform of the spectrum 0.0229 r0^(-5/3) (k^2 + 1 / L0^2)^(-11/6), k in cycles.
double von_karman_structure(double separation, double r0, double outer_scale);

}  // namespace dmise
