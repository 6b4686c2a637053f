#include "sensors/sky/star_path_kernels.h"

#include "core/base/numeric/lanes.h"

namespace dmise::DMISE_SIMD {
namespace {

using Four = double __attribute__((vector_size(32)));  // wherever there are fewer lanes, in parts

/// Lagrange's weights of nodes at 0, 1 and 2.
struct Weights {
  double of[3];
  explicit Weights(double u)
      : of{0.5 * (u - 1.0) * (u - 2.0), u * (2.0 - u), 0.5 * u * (u - 1.0)} {}
};

}  // namespace

void interpolate_paths(const double* nodes, std::size_t across, const PatchPlace* places,
                       std::size_t count, double* values) {
  constexpr std::size_t parts = path_values / 4;
  for (std::size_t i = 0; i < count; ++i, values += path_values) {
    const Weights along(places[i].u), down(places[i].v);
    Four sum[parts] = {};
    for (std::size_t b = 0; b < 3; ++b) {
      const double* row = nodes + (places[i].node + b * across) * path_values;
      for (std::size_t a = 0; a < 3; ++a) {
        const double weight = along.of[a] * down.of[b];
        for (std::size_t k = 0; k < parts; ++k)
          sum[k] += weight * load<Four>(row + a * path_values + 4 * k);
      }
    }
    for (std::size_t k = 0; k < parts; ++k) store(values + 4 * k, sum[k]);
  }
}

}  // namespace dmise::DMISE_SIMD
