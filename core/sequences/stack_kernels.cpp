#include "core/sequences/stack_kernels.h"

#include "core/base/numeric/lanes.h"

namespace dmise::DMISE_SIMD {
namespace {

// As many values on every instruction set.
using Row = float __attribute__((vector_size(4 * stack_lanes)));
using RowMask = std::int32_t __attribute__((vector_size(4 * stack_lanes)));
using Rates = std::uint32_t __attribute__((vector_size(4 * stack_lanes)));

constexpr float no_weight2 = 1e-30F;

}  // namespace

void stack_rows(const StackRows& rows, std::size_t columns, std::uint32_t rate,
                const StackBest& best) {
  for (std::size_t x = 0; x < columns; x += stack_lanes) {
    Row light{}, weight2{};
    for (std::size_t i = 0; i < rows.frames; ++i) {
      light += load<Row>(rows.light[i] + x);
      weight2 += load<Row>(rows.weight2[i] + x);
    }
    const Row seen = light > 0.0F ? light : Row{};
    const Row snr2 = seen * seen / (weight2 + no_weight2);
    const Row before = load<Row>(best.snr2 + x);
    const RowMask better = snr2 > before;
    store(best.snr2 + x, better ? snr2 : before);
    const Rates rates = load<Rates>(best.rate + x);
    store(best.rate + x, better ? Rates{} + rate : rates);
  }
}

}  // namespace dmise::DMISE_SIMD
