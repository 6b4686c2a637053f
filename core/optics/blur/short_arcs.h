#pragma once
#include <array>

#include "core/base/pixel.h"
#include "core/optics/blur/deposit_kernels.h"
#include "core/optics/psf_table.h"

namespace dmise {

/// Number of Gauss-Legendre nodes of an arc that may miss a little light in a pixel: the fewest
/// that miss no more. The remainder of n nodes over a path of L pixels is L^(2n) (n!)^4 / ((2n+1)
/// (2n)!^3) times the derivative of order 2n of the density of light, (2n-1)!! over width^(2n) of a
/// Gaussian. A Gaussian narrower than 0.58 px that is integrated over a pixel has steeper edges
/// than one as wide as both: its width is taken to be 1.12 times its own.
class ShortArcRule {
 public:
  explicit ShortArcRule(const PsfTable& psf);

  /// Nodes of an arc; 0: more than `max_short_nodes`. `square_px2`: of its length.
  int nodes(double signal_e, double may_miss_e, double square_px2) const {
    const double square = square_px2 * per_width2_;
    double missed_e = signal_e;
    for (std::size_t n = 0; n < missed_.size(); ++n) {
      missed_e *= square;
      if (missed_e * missed_[n] <= may_miss_e) return int(n) + 1;
    }
    return 0;
  }

 private:
  double per_width2_;
  std::array<double, max_short_nodes> missed_;  // share of the light, in the brightest pixel
};

}  // namespace dmise
