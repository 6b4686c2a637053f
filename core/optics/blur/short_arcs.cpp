#include "core/optics/blur/short_arcs.h"

#include <algorithm>

namespace dmise {

ShortArcRule::ShortArcRule(const PsfTable& psf) {
  constexpr double two_pi = 6.283185307179586;
  const double sigma2 = psf.sigma_px * psf.sigma_px;
  const double width2 = sigma2 + std::min(1.0 / 12.0, 0.25 * sigma2);
  per_width2_ = 1.0 / width2;
  // (n!)^4 (2n-1)!! / ((2n+1) (2n)!^3), by the ratio of one to the next.
  double missed = 1.0;
  for (std::size_t n = 1; n <= missed_.size(); ++n) {
    const double m = double(n), even = 2.0 * m, odd = even - 1.0;
    missed *= m * m * m * m * odd / ((even * odd) * (even * odd) * (even * odd));
    missed_[n - 1] = missed / (even + 1.0) / (two_pi * width2);
  }
}

}  // namespace dmise
