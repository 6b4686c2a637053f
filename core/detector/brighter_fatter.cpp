#include "core/detector/brighter_fatter.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/detector/detector.h"
#include "core/effects/plan_facts.h"

namespace dmise {
namespace {

constexpr int reach = 3;  // pixels on either side of a boundary

/// Power of the distance with which the pull of a charge falls: 3/2 agrees to 6 % with GalSim's
/// solutions of Poisson's equation for spots of 2 to 6 px.
constexpr double falloff = 1.5;

/// Displacement of the boundary between (0, 0) and (1, 0) towards the charge of pixel (i, j), over
/// that by the charge of (1, 0).
double pull(int i, int j) {
  const double x = i - 0.5, r = std::hypot(x, j);
  return x / r * std::pow(0.5 / r, falloff);
}

/// Rows about a run of pixels in one row, each with `margin` pixels before and after it. Beyond the
/// frame there is what its edge has.
class Rows {
 public:
  Rows(const ElectronImage& e, int y, int left, int count) : width_(count + 2 * margin) {
    for (int j = -margin; j <= margin; ++j) {
      const float* row = e.row(std::clamp(y + j, 0, e.rows - 1));
      for (int i = -margin; i < count + margin; ++i)
        pixels_.push_back(row[std::clamp(left + i, 0, e.columns - 1)]);
    }
  }
  static constexpr int margin = reach + 1;
  /// Pixel 0 of the run, in the row `j` away from it.
  const float* row(int j) const { return pixels_.data() + (j + margin) * width_ + margin; }

 private:
  int width_;
  std::vector<float> pixels_;
};

/// Charge that crosses the boundary from each of `count` pixels, from `first` on, to its neighbour
/// on the right (down: below) in the row `row`.
void crossing(const Rows& rows, bool down, int row, int first, int count, double per_e,
              std::vector<double>& flux) {
  flux.assign(std::size_t(count), 0.0);
  for (int i = 1 - reach; i <= reach; ++i)
    for (int j = -reach; j <= reach; ++j) {
      const double weight = -pull(i, j);
      const float* e = rows.row(row + (down ? i : j)) + first + (down ? j : i);
      for (int k = 0; k < count; ++k) flux[std::size_t(k)] += weight * e[k];
    }
  const float* here = rows.row(row) + first;
  const float* there = down ? rows.row(row + 1) + first : here + 1;
  for (int k = 0; k < count; ++k)
    flux[std::size_t(k)] *= 0.5 * per_e * 0.5 * (double(here[k]) + there[k]);
}

}  // namespace

double BrighterFatter::cost_s(int level, const PlanFacts& f) { return level * 30e-9 * f.pixels(); }

std::span<const ParameterOf<BrighterFatter>> BrighterFatter::parameters() {
  static constexpr ParameterOf<BrighterFatter> table[] = {
      {"brighter_fatter_per_e", "BFATTER", "[px/e-] boundaries move by a pixel's own charge",
       &BrighterFatter::brighter_fatter_per_e, 0.0, 1e-4}};
  return table;
}

std::optional<DetectorFault> BrighterFatter::fault(const Detector& d) {
  // A boundary may not come near the middle of a pixel.
  if (d.brighter_fatter_per_e * d.full_well_e <= 0.25) return std::nullopt;
  return DetectorFault{"brighter_fatter_per_e", "times full_well_e must be at most 0.25",
                       d.brighter_fatter_per_e};
}

void BrighterFatter::apply(const ExposureFacts&, const ElectronImage& electrons,
                           Piece& piece) const {
  const auto columns = std::size_t(electrons.columns);
  std::vector<double> right, above, below;
  for (std::size_t done = 0; done < piece.electrons.size();) {
    const std::size_t at = piece.first + done;
    const int x = int(at % columns), y = int(at / columns);
    const int count = int(std::min(columns - std::size_t(x), piece.electrons.size() - done));
    const Rows rows(electrons, y, x, count);
    const double per_e = brighter_fatter_per_e;
    crossing(rows, false, 0, -1, count + 1, per_e, right);
    crossing(rows, true, -1, 0, count, per_e, above);
    crossing(rows, true, 0, 0, count, per_e, below);
    if (x == 0) right.front() = 0.0;
    if (x + count == electrons.columns) right.back() = 0.0;
    if (y == 0) std::fill(above.begin(), above.end(), 0.0);
    if (y == electrons.rows - 1) std::fill(below.begin(), below.end(), 0.0);
    for (int k = 0; k < count; ++k) {
      const auto i = std::size_t(k);
      const double own_e = electrons.pixels[at + i];
      piece.electrons[done + i] =
          std::max(0.0f, float(own_e + right[i] - right[i + 1] + above[i] - below[i]));
    }
    done += std::size_t(count);
  }
}

}  // namespace dmise
