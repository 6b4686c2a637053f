#include "core/detection/light/trail_kernels.h"

#include "core/base/numeric/lanes.h"
#include "core/detection/light/trail_lanes.h"

namespace dmise::DMISE_SIMD {
namespace {

constexpr int places = wide_lanes;
using Index = std::int32_t __attribute__((vector_size(places * 4)));

DMISE_INLINE F64 gather(const double* from, Index at) {
#if defined(__AVX512F__)
  return (F64)_mm512_i32gather_pd((__m256i)at, from, 8);
#elif defined(__AVX2__)
  return (F64)_mm256_i32gather_pd(from, (__m128i)at, 8);
#else
  return F64{from[at[0]], from[at[1]]};
#endif
}

DMISE_INLINE F64 held(F64 v, double to) { return min(max(v, splat(-to)), splat(to)); }

/// The normal distribution at each lane.
struct NormalLanes {
  const NormalTable& table;

  F64 pdf(F64 x) const __attribute__((always_inline)) {
    const Near near(x);
    const F64 p = gather(table.pdf, near.at);
    return ((x > -NormalTable::reach) & (x <= NormalTable::reach)) ? near.pdf(p) : F64{};
  }
  void both(F64 x, F64& cdf, F64& pdf) const __attribute__((always_inline)) {
    const F64 above = x > NormalTable::reach ? F64{} + 1.0 : F64{};
    const I64 within = (x > -NormalTable::reach) & (x <= NormalTable::reach);
    cdf = above;
    pdf = F64{};
    if (!any(within)) return;  // far from an end
    const Near near(x);
    const F64 p = gather(table.pdf, near.at);
    cdf = within ? near.cdf(gather(table.cdf, near.at), p) : above;
    pdf = within ? near.pdf(p) : pdf;
  }

 private:
  struct Near {
    Index at;
    F64 x0, h;

    __attribute__((always_inline)) explicit Near(F64 x) {
      const F64 inside = held(x, NormalTable::reach);
      at = __builtin_convertvector(inside * (1 / NormalTable::step) + (NormalTable::half + 0.5),
                                   Index);
      x0 = (__builtin_convertvector(at, F64) - double(NormalTable::half)) * NormalTable::step;
      h = inside - x0;
    }
    F64 pdf(F64 p) const __attribute__((always_inline)) { return normal_pdf_near(x0, h, p); }
    F64 cdf(F64 c, F64 p) const __attribute__((always_inline)) {
      return normal_cdf_near(x0, h, c, p);
    }
  };
};

/// Eight lanes on every instruction set, so that sums have one order.
constexpr int lanes_of_sum = 8, vectors = lanes_of_sum / places;
constexpr int rounds = int(trail_block) / lanes_of_sum;

struct LaneSum {
  F64 of[vectors] = {};

  double total() const __attribute__((always_inline)) {
    double sum = 0.0;
    for (int v = 0; v < vectors; ++v)
      for (int i = 0; i < places; ++i) sum += of[v][i];
    return sum;
  }
};

/// Adds a trail's light to `model`; `keep` gets its derivatives.
template <class Keep>
DMISE_INLINE void for_places(const TrailShape& trail, const NormalTable& normal, const double* x,
                             const double* y, double* model, const Keep& keep) {
  const NormalLanes lanes_of_normal{normal};
  const auto within = [](F64 v) __attribute__((always_inline)) { return held(v, 1.0); };
  for (std::size_t i = 0; i < trail_block; i += places) {
    F64 d[7];
    const F64 light =
        light_of_trail(trail, load<F64>(x + i), load<F64>(y + i), lanes_of_normal, within, d);
    store(model + i, load<F64>(model + i) + light);
    keep(i, d);
  }
}

}  // namespace

void trail_light(const TrailShape& trail, const NormalTable& normal, const double* x,
                 const double* y, double* model, double (*derivatives)[trail_block]) {
  for_places(
      trail, normal, x, y, model, [&](std::size_t i, const F64* d) __attribute__((always_inline)) {
        for (int k = 0; k < 7; ++k) store(derivatives[k] + i, d[k]);
      });
}

void trail_values(const TrailShape& trail, const NormalTable& normal, const double* x,
                  const double* y, double* model) {
  for_places(trail, normal, x, y, model,
             [](std::size_t, const F64*) __attribute__((always_inline)){});
}

void normal_below_each(const NormalTable& normal, const double* x, std::size_t count, double* out) {
  const NormalLanes lanes_of_normal{normal};
  for (std::size_t i = 0; i < count; i += places) {
    const std::size_t n = count - i < std::size_t(places) ? count - i : std::size_t(places);
    F64 at{}, below, density;
    __builtin_memcpy(&at, x + i, n * sizeof(double));
    lanes_of_normal.both(at, below, density);
    __builtin_memcpy(out + i, &below, n * sizeof(double));
  }
}

void add_block(const TrailPixels& pixels, const double* model, double background_e,
               double model_error, const double* const* gradients, std::size_t n, double* variance,
               TrailSums& to) {
  double weight[trail_block], weighted_residual[trail_block];
  LaneSum chi2, merit;
  F64 lane[vectors];
  for (int v = 0; v < vectors; ++v)
    for (int i = 0; i < places; ++i) lane[v][i] = v * places + i;
  const auto used = double(pixels.used);
  for (int round = 0; round < rounds; ++round)
    for (int v = 0; v < vectors; ++v) {
      const int i = round * lanes_of_sum + v * places;
      const F64 light = load<F64>(model + i), error = model_error * light;
      const F64 all = load<F64>(pixels.variance_e2 + i) + max(light, F64{}) + error * error;
      const F64 residual = load<F64>(pixels.signal_e + i) - light - background_e;
      const F64 counts = lane[v] + double(round * lanes_of_sum) < used ? F64{} + 1.0 : F64{};
      const F64 w = counts / all;
      const F64 square = residual * residual;
      chi2.of[v] += square * w;
      merit.of[v] += counts * (square / (pixels.before ? load<F64>(pixels.before + i) : all));
      store(variance + i, all);
      store(weight + i, w);
      store(weighted_residual + i, w * residual);
    }
  to.chi2 += chi2.total();
  to.merit += merit.total();
  for (std::size_t row = 0; row < n; ++row) {
    const double* g = gradients[row];
    LaneSum right;
    F64 weighted[rounds * vectors];
    for (int k = 0; k < rounds * vectors; ++k) {
      const F64 value = load<F64>(g + k * places);
      weighted[k] = value * load<F64>(weight + k * places);
      right.of[k % vectors] += value * load<F64>(weighted_residual + k * places);
    }
    to.right[row] += right.total();
    for (std::size_t column = 0; column <= row; ++column) {
      LaneSum sum;
      for (int k = 0; k < rounds * vectors; ++k)
        sum.of[k % vectors] += weighted[k] * load<F64>(gradients[column] + k * places);
      to.matrix[row][column] += sum.total();
    }
  }
}

}  // namespace dmise::DMISE_SIMD
