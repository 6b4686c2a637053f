#include "core/optics/lens_ghost.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/effects/plan_facts.h"
#include "core/optics/image_optics.h"

namespace dmise {

ErrorBound LensGhost::error(int, const PlanFacts& f) const {
  const double disc_px = std::max(1.0, std::numbers::pi * ghost_radius_px * ghost_radius_px);
  ErrorBound error = f.without_light(
      [&](const SkySample& s) { return ghost_fraction * (f.brightest_e() / disc_px + s.sky_e); });
  // A faint source in the ghost of a bright one, which adds at most a tenth of its light: with
  // more it would not count as alone.
  const double capsule_px = 28.0 * std::max(1.0, f.fwhm_px * f.fwhm_px);
  const double share = std::min(0.1, ghost_fraction * std::min(1.0, capsule_px / disc_px) *
                                         f.brightest_e() / f.faintest_source_e());
  error.photometry_mag = 1.086 * (ghost_fraction + share);
  error.position_px = 3.0 * share * std::hypot(1.0, f.fwhm_px);
  return error;
}

double LensGhost::cost_s(int level, const PlanFacts& f) { return level * 10e-9 * f.pixels(); }

std::span<const ImageParameter> LensGhost::parameters() {
  static constexpr ImageParameter table[] = {
      {"ghost_fraction", "GHOSTFR", "share of the light in the lens's ghost",
       &LensGhost::ghost_fraction, 0.0, 0.1},
      {"ghost_radius_px", "GHOSTRAD", "[px] radius of the ghost of a point",
       &LensGhost::ghost_radius_px, 0.5, 500.0}};
  return table;
}

void LensGhost::apply(ExpectedElectronImage& image, Threads& threads) const {
  const ExpectedElectronImage source = image;
  const int columns = image.columns, rows = image.rows, reach = int(ghost_radius_px);
  std::vector<int> half_width;  // the disc's, by row distance from its centre
  std::size_t pixels = 0;
  for (int dy = 0; dy <= reach; ++dy) {
    half_width.push_back(int(std::sqrt(ghost_radius_px * ghost_radius_px - dy * dy)));
    pixels += std::size_t(dy == 0 ? 1 : 2) * std::size_t(2 * half_width.back() + 1);
  }
  const double share = ghost_fraction / double(pixels);
  threads.for_ranges(std::size_t(rows), 64, [&](std::size_t begin, std::size_t end) {
    // Running sums of the rows that contribute to the ghost's rows.
    const int first = std::max(0, rows - int(end) - reach);
    const int last = std::min(rows - 1, rows - 1 - int(begin) + reach);
    const auto stride = std::size_t(columns) + 1;
    std::vector<double> sums(stride * std::size_t(last - first + 1));
    for (int y = first; y <= last; ++y) {
      double* sum = sums.data() + stride * std::size_t(y - first);
      for (int x = 0; x < columns; ++x) sum[x + 1] = sum[x] + source.at(x, y);
    }
    std::vector<double> gained(static_cast<std::size_t>(columns));
    for (int y = int(begin); y < int(end); ++y) {
      std::fill(gained.begin(), gained.end(), 0.0);
      for (int dy = -reach; dy <= reach; ++dy) {
        const int from = rows - 1 - y + dy;
        if (from < 0 || from >= rows) continue;
        const double* sum = sums.data() + stride * std::size_t(from - first);
        const int half = half_width[std::size_t(std::abs(dy))];
        for (int x = 0; x < columns; ++x) {
          const int middle = columns - 1 - x;
          gained[std::size_t(x)] +=
              sum[std::min(columns, middle + half + 1)] - sum[std::max(0, middle - half)];
        }
      }
      for (int x = 0; x < columns; ++x) image.at(x, y) += float(share * gained[std::size_t(x)]);
    }
  });
}

}  // namespace dmise
