#include "sensors/accuracy/source_capsule.h"

namespace dmise {
namespace {

double distance_px(PixelPosition p, PixelPosition from, PixelPosition to) {
  const PixelPosition way = to - from, past = p - from;
  const double length2 = way.x_px * way.x_px + way.y_px * way.y_px;
  const double at =
      length2 > 0.0 ? std::clamp((past.x_px * way.x_px + past.y_px * way.y_px) / length2, 0.0, 1.0)
                    : 0.0;
  return std::hypot(past.x_px - at * way.x_px, past.y_px - at * way.y_px);
}

}  // namespace

double distance_px(PixelPosition p, const ReferenceSource& s) {
  double least = distance_px(p, s.trail[0], s.trail[1]);
  for (std::size_t i = 2; i < s.trail.size(); ++i)
    least = std::min(least, distance_px(p, s.trail[i - 1], s.trail[i]));
  return least;
}

std::vector<PixelPosition> line_along(PixelPosition from, PixelPosition via, PixelPosition to) {
  constexpr double off_px = 0.05;
  constexpr int max_chords = 64;
  // At -1, 0 and 1: via + half * t + bend * t * t.
  const PixelPosition half = (to - from) * 0.5, bend = (to + from) * 0.5 - via;
  const double chords = std::ceil(std::sqrt(std::hypot(bend.x_px, bend.y_px) / off_px));
  const int count = int(std::clamp(chords, 1.0, double(max_chords)));
  std::vector<PixelPosition> line;
  for (int i = 0; i <= count; ++i) {
    const double t = 2.0 * i / count - 1.0;
    line.push_back(via + half * t + bend * (t * t));
  }
  return line;
}

}  // namespace dmise
