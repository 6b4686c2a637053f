#include "core/optics/vignetting.h"

#include <algorithm>
#include <cmath>

#include "core/optics/projection.h"

namespace dmise {

double relative_illumination(const Optics& optics, PixelPosition pixel) {
  const Vignetting& v = optics.vignetting;
  if (!v.any()) return 1.0;
  double share = 1.0;
  if (v.natural) {
    const auto direction = unproject(optics, pixel);
    share = direction ? std::max(0.0, direction->z) : 0.0;
  }
  if (v.corner < 1.0) {
    const PixelPosition d = pixel - principal_point(optics);
    const double corner_px = 0.5 * std::hypot(optics.columns, optics.rows);
    const double r = std::min(1.0, std::hypot(d.x_px, d.y_px) / corner_px);
    share *= 1.0 - (1.0 - v.corner) * std::pow(r, v.power);
  }
  return share;
}

}  // namespace dmise
