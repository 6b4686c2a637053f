#include "core/detection/light/star_kernels.h"

#include "core/base/numeric/lanes.h"

namespace dmise::DMISE_SIMD {
namespace {

// As many values on every instruction set, so that sums have one order.
using Row = float __attribute__((vector_size(4 * star_lanes)));
using RowMask = std::int32_t __attribute__((vector_size(4 * star_lanes)));
using Steps = std::int8_t __attribute__((vector_size(star_lanes)));

DMISE_INLINE Row of(float x) { return x - Row{}; }
DMISE_INLINE RowMask numbers() {
  return RowMask{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
}

/// exp(x) of x <= 0 to 2e-7; less than exp(-87) is 0.
DMISE_INLINE Row exponential(Row x) {
  const Row scaled = x * 1.44269504F;
  const RowMask whole = __builtin_convertvector(scaled - 0.5F, RowMask);
  const Row n = __builtin_convertvector(whole, Row);
  const Row f = (x - n * 0.693359375F) + n * 2.12194440e-4F;  // less n ln 2, in two parts
  Row p = of(1.9875691500e-4F);
  p = p * f + 1.3981999507e-3F;
  p = p * f + 8.3334519073e-3F;
  p = p * f + 4.1665795894e-2F;
  p = p * f + 1.6666665459e-1F;
  p = p * f + 5.0000001201e-1F;
  p = p * (f * f) + f + 1.0F;
  const Row power = bits<Row>((whole + 127) << 23);
  return x > -87.0F ? p * power : Row{};
}

DMISE_INLINE float sum_of(Row v) {
  float sums[star_lanes];
  store(sums, v);
  for (std::size_t n = star_lanes / 2; n > 0; n /= 2)
    for (std::size_t i = 0; i < n; ++i) sums[i] += sums[i + n];
  return sums[0];
}

}  // namespace

void draw_points(const StarPoint* points, std::size_t count, float each, float curvature,
                 const StarCanvas& to) {
  const std::size_t tall = (to.rows + star_lanes - 1) / star_lanes * star_lanes;
  float* across = to.scratch;
  float* down = to.scratch + count * to.stride;
  const auto profile = [&](float centre, std::int32_t first, std::int32_t last, float factor,
                           std::size_t length, float* out) {
    for (std::size_t i = 0; i < length; i += star_lanes) {
      const RowMask at = numbers() + std::int32_t(i);
      const Row off = __builtin_convertvector(at, Row) - centre;
      const Row light = factor * exponential(curvature * off * off);
      const RowMask inside = (at >= first) & (at <= last);
      store(out + i, inside ? light : Row{});
    }
  };
  for (std::size_t k = 0; k < count; ++k) {
    const StarPoint& p = points[k];
    profile(p.x_px, p.left, p.right, each, to.stride, across + k * to.stride);
    profile(p.y_px, p.top, p.bottom, 1.0F, tall, down + k * tall);
  }
  const float steepness = -2 * curvature;
  for (std::size_t y = 0; y < to.rows; ++y)
    for (std::size_t x = 0; x < to.stride; x += star_lanes) {
      const std::size_t place = y * to.stride + x;
      Row light{}, by_x{}, by_y{};
      const Row at = __builtin_convertvector(numbers() + std::int32_t(x), Row);
      for (std::size_t k = 0; k < count; ++k) {
        const Row one = load<Row>(across + k * to.stride + x) * down[k * tall + y];
        light += one;
        if (!to.by_x) continue;
        by_x += steepness * (at - points[k].x_px) * one;
        by_y += steepness * (float(std::int32_t(y)) - points[k].y_px) * one;
      }
      store(to.light + place, light);
      if (!to.by_x) continue;
      store(to.by_x + place, by_x);
      store(to.by_y + place, by_y);
    }
}

void subtract_light(const float* light, float hidden, std::size_t count, bool odd,
                    std::int8_t* steps) {
  constexpr float most = 31.0F, per_sigma = 5.0F;  // FilteredFrame
  const RowMask sign_of_zero = 2 * ((numbers() + std::int32_t(odd)) & 1) - 1;
  for (std::size_t x = 0; x < count; x += star_lanes) {
    const std::size_t n = count - x < star_lanes ? count - x : star_lanes;
    Steps before{};
    __builtin_memcpy(&before, steps + x, n);
    const RowMask wide = __builtin_convertvector(before, RowMask);
    const Row drawn = load<Row>(light + x);
    Row scaled = (__builtin_convertvector(wide, Row) / per_sigma - drawn) * per_sigma;
    scaled = scaled > most ? of(most) : scaled;
    scaled = scaled < -most ? of(-most) : scaled;
    const Row half = scaled < 0.0F ? of(-0.5F) : of(0.5F);
    const RowMask step = __builtin_convertvector(scaled + half, RowMask);
    const RowMask seen = step != 0 ? step : sign_of_zero;
    const RowMask left = ((wide == 0) | (drawn > hidden)) ? RowMask{} : seen;
    const Steps after = __builtin_convertvector(left, Steps);
    __builtin_memcpy(steps + x, &after, n);
  }
}

/// One bit for each of `bytes`: whether it is negative.
DMISE_INLINE std::uint32_t signs_of(Steps bytes) {
#if defined(__x86_64__)
  return std::uint32_t(_mm_movemask_epi8((__m128i)bytes));
#else
  std::uint32_t out = 0;
  for (std::size_t i = 0; i < star_lanes; ++i) out |= std::uint32_t(bytes[i] < 0) << i;
  return out;
#endif
}

std::uint64_t bits_above(const float* values, std::size_t count, float least) {
  std::uint64_t out = 0;
  for (std::size_t x = 0; x < count; x += star_lanes) {
    const RowMask above = load<Row>(values + x) > least;
    const Steps bytes = __builtin_convertvector(above, Steps);
    out |= std::uint64_t(signs_of(bytes)) << x;
  }
  return count < 64 ? out & ((std::uint64_t(1) << count) - 1) : out;
}

void add_pixels(const float* light, const float* by_x, const float* by_y, const float* pixels,
                std::size_t stride, std::size_t rows, float photons, float model_error,
                StarSums& sums) {
  Row right[3]{}, matrix[6]{};
  RowMask used{};
  for (std::size_t i = 0; i < stride * rows; i += star_lanes) {
    const Row pixel = load<Row>(pixels + i), shape = load<Row>(light + i);
    const RowMask is_number = pixel == pixel;
    const Row error = model_error * shape;
    const Row weight = is_number ? 1.0F / (1.0F + shape * photons + error * error) : Row{};
    const Row residual = is_number ? pixel - shape : Row{};
    const Row by[3] = {shape, load<Row>(by_x + i), load<Row>(by_y + i)};
    for (int a = 0, k = 0; a < 3; ++a) {
      const Row weighted = weight * by[a];
      right[a] += weighted * residual;
      for (int b = 0; b <= a; ++b, ++k) matrix[k] += weighted * by[b];
    }
    used -= is_number;
  }
  for (int a = 0; a < 3; ++a) sums.right[a] = sum_of(right[a]);
  for (int k = 0; k < 6; ++k) sums.matrix[k] = sum_of(matrix[k]);
  for (std::size_t i = 0; i < star_lanes; ++i) sums.used += used[i];
}

}  // namespace dmise::DMISE_SIMD
