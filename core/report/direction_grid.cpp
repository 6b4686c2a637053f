#include "core/report/direction_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/report/compact_bytes.h"

namespace dmise {
namespace {

constexpr double wanted_px = 0.05;
constexpr int max_cells = 64, sky_parts = 96;
constexpr double unit_of_nodes = 1.0 / (1 << 30);

/// Weights of the cubic through values at -1, 0, 1 and 2.
std::array<double, 4> weights(double t) {
  return {-t * (t - 1) * (t - 2) / 6, (t + 1) * (t - 1) * (t - 2) / 2, -(t + 1) * t * (t - 2) / 2,
          (t + 1) * t * (t - 1) / 6};
}

class Nodes {
 public:
  Nodes(const Wcs& wcs, int columns, int rows, int across, int down)
      : across_(across), down_(down), columns_(columns), rows_(rows) {
    for (int j = 0; j < down + 3; ++j)
      for (int i = 0; i < across + 3; ++i)
        at_.push_back(wcs_direction(
            wcs, {double(i - 1) * columns / across - 0.5, double(j - 1) * rows / down - 0.5}));
  }
  Vec<Gcrs> direction(PixelPosition p) const {
    const double u = (p.x_px + 0.5) * across_ / columns_, v = (p.y_px + 0.5) * down_ / rows_;
    const int i = std::clamp(int(u), 0, across_ - 1), j = std::clamp(int(v), 0, down_ - 1);
    const auto wx = weights(u - i), wy = weights(v - j);
    Vec<Gcrs> sum{};
    for (int b = 0; b < 4; ++b)
      for (int a = 0; a < 4; ++a)
        sum = sum + at_[std::size_t((j + b) * (across_ + 3) + i + a)] *
                        (wx[std::size_t(a)] * wy[std::size_t(b)]);
    return unit(sum);
  }
  std::string packed() const {
    std::vector<std::int32_t> numbers;
    for (const auto axis : {&Vec<Gcrs>::x, &Vec<Gcrs>::y, &Vec<Gcrs>::z})
      for (const Vec<Gcrs>& v : at_)
        numbers.push_back(std::int32_t(std::lround(v.*axis / unit_of_nodes)));
    return compact(byte_planes(numbers));
  }

 private:
  int across_, down_, columns_, rows_;
  std::vector<Vec<Gcrs>> at_;
};

struct Probe {
  PixelPosition pixel;
  Vec<Gcrs> direction;
  double pixel_rad = 0.0;  // the smaller side of this pixel
};

std::vector<Probe> probes_of(const Wcs& wcs, int columns, int rows) {
  std::vector<Probe> probes;
  constexpr int across = 23;  // no multiple of cells
  for (int j = 0; j < across; ++j)
    for (int i = 0; i < across; ++i) {
      const PixelPosition p{(i + 0.5) * columns / across - 0.5, (j + 0.5) * rows / across - 0.5};
      if (!wcs_sees_sky(wcs, p)) continue;
      const Vec<Gcrs> here = wcs_direction(wcs, p);
      const double right = norm(wcs_direction(wcs, p + PixelPosition{0.5, 0}) - here) / 0.5;
      const double down = norm(wcs_direction(wcs, p + PixelPosition{0, 0.5}) - here) / 0.5;
      const double least = std::min(right, down);
      if (least > 0.0) probes.push_back({p, here, least});
    }
  return probes;
}

void find_sky(const Wcs& wcs, int columns, int rows, DirectionGrid& grid) {
  const int across = std::min(sky_parts, columns), down = std::min(sky_parts, rows);
  std::string seen;
  for (int j = 0; j < down; ++j)
    for (int i = 0; i < across; ++i)
      seen += char(
          wcs_sees_sky(wcs, {(i + 0.5) * columns / across - 0.5, (j + 0.5) * rows / down - 0.5}));
  if (seen.find('\0') == std::string::npos) return;
  grid.sky_across = across;
  grid.sky_down = down;
  grid.sky = compact(seen);
}

}  // namespace

DirectionGrid direction_grid(const Wcs& wcs, int columns, int rows) {
  DirectionGrid grid;
  const std::vector<Probe> probes = probes_of(wcs, columns, rows);
  for (int cells = 2; cells <= max_cells; cells *= 2) {
    const Nodes nodes(wcs, columns, rows, cells, cells);
    grid.error_px = 0.0;
    for (const Probe& p : probes)
      grid.error_px =
          std::max(grid.error_px, norm(nodes.direction(p.pixel) - p.direction) / p.pixel_rad);
    if (grid.error_px > wanted_px && cells < max_cells) continue;
    grid.across = grid.down = cells;
    grid.nodes = nodes.packed();
    break;
  }
  find_sky(wcs, columns, rows, grid);
  return grid;
}

}  // namespace dmise
