#include "core/detection/streaks/point_kernels.h"

#include "core/base/numeric/lanes.h"

namespace dmise::DMISE_SIMD {
namespace {

/// Eight lanes on every instruction set, so that sums have one order.
constexpr int lanes_of_sum = 8, vectors = lanes_of_sum / wide_lanes;

}  // namespace

double weight_within(const WeighedPoints& points, const PointLine& line, double width,
                     double most) {
  F64 sums[vectors] = {};
  double sum = 0.0;
  for (std::size_t b = 0; b < points.blocks && sum + points.after[b] > most; ++b) {
    for (std::size_t i = b * point_block; i < (b + 1) * point_block; i += lanes_of_sum)
      for (int v = 0; v < vectors; ++v) {
        const std::size_t at = i + std::size_t(v * wide_lanes);
        const F64 off = (load<F64>(points.y + at) - line.y) * line.ux -
                        (load<F64>(points.x + at) - line.x) * line.uy;
        const I64 near = (off < width) & (-off < width);
        sums[v] += near ? load<F64>(points.weight + at) : F64{};
      }
    sum = 0.0;
    for (const F64& some : sums)
      for (int i = 0; i < wide_lanes; ++i) sum += some[i];
  }
  return sum;
}

}  // namespace dmise::DMISE_SIMD
