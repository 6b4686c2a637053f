#include "core/optics/blur/snapshots.h"

#include <algorithm>

namespace dmise {

std::vector<Arc> as_snapshots(std::span<const Arc> path, int count) {
  std::vector<Arc> points;
  double whole_e = 0.0, seen_e = 0.0;
  for (const auto& arc : path) whole_e += arc.signal_e;
  for (int i = 0; i < count && !path.empty(); ++i) {
    const double at = (i + 0.5) / count * double(path.size());
    const std::size_t k = std::min(std::size_t(at), path.size() - 1);
    const double tau = at - double(k);
    const PixelPosition p = place(path[k], tau);
    const double signal_e =
        path[k].signal_e * double(path.size()) / count * (1.0 + path[k].tilt * (2.0 * tau - 1.0));
    points.push_back({p, p, p, signal_e, 0.0});
    seen_e += signal_e;
  }
  if (seen_e > 0.0)
    for (auto& point : points) point.signal_e *= whole_e / seen_e;
  return points;
}

}  // namespace dmise
