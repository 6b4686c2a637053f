#include "sensors/survey/trail_in_frame.h"

#include <algorithm>
#include <cmath>

#include "core/optics/projection.h"

namespace dmise {
namespace {

constexpr int pieces = 16;  // steps along each parabola

double on_parabola(double a, double m, double b, double u) {
  return a * (1 - u) * (1 - 2 * u) + m * 4 * u * (1 - u) + b * u * (2 * u - 1);
}

}  // namespace

TrailInFrame trail_in_frame(std::span<const ObjectSample> samples, double seconds,
                            const Optics& optics) {
  TrailInFrame trail;
  const std::size_t arcs = (samples.size() - 1) / 2;
  const double piece_s = seconds / double(arcs * pieces);
  double sum_x = 0.0, sum_y = 0.0;
  for (std::size_t k = 0; k < arcs; ++k) {
    const ObjectSample &a = samples[2 * k], &m = samples[2 * k + 1], &b = samples[2 * k + 2];
    if (!a.pixel || !m.pixel || !b.pixel) continue;
    const auto place = [&](double u) {
      return PixelPosition{on_parabola(a.pixel->x_px, m.pixel->x_px, b.pixel->x_px, u),
                           on_parabola(a.pixel->y_px, m.pixel->y_px, b.pixel->y_px, u)};
    };
    PixelPosition before = place(0.0);
    for (int i = 0; i < pieces; ++i) {
      const PixelPosition after = place((i + 1.0) / pieces);
      const PixelPosition middle = place((i + 0.5) / pieces);
      const double rate = std::max(0.0, on_parabola(a.electrons_per_s, m.electrons_per_s,
                                                    b.electrons_per_s, (i + 0.5) / pieces));
      if (in_frame(optics, middle) && rate > 0.0) {
        const double light_e = rate * piece_s;
        trail.signal_e += light_e;
        sum_x += light_e * middle.x_px;
        sum_y += light_e * middle.y_px;
        trail.length_px += std::hypot(after.x_px - before.x_px, after.y_px - before.y_px);
      }
      before = after;
    }
  }
  if (trail.signal_e > 0.0) trail.centroid = {sum_x / trail.signal_e, sum_y / trail.signal_e};
  return trail;
}

}  // namespace dmise
