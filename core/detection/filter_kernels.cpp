#include "core/detection/filter_kernels.h"

#include "core/base/lanes.h"

namespace dmise::DMISE_SIMD {
namespace {

constexpr float most = 31.0f;  // FilteredFrame::most
constexpr float per_sigma = 5.0f;

/// The nearest step, as a column of parity `odd` tells the sign of 0.
DMISE_INLINE std::int32_t rounded(float scaled, std::int32_t odd) {
  scaled = scaled > most ? most : scaled;
  scaled = scaled < -most ? -most : scaled;
  const auto step = std::int32_t(scaled + (scaled < 0 ? -0.5f : 0.5f));
  return step != 0 ? step : 2 * odd - 1;
}

}  // namespace

void steps_of(const float* value, const float* noise, float unit, std::size_t count, bool odd,
              std::int8_t* out) {
  for (std::size_t x = 0; x < count; ++x)
    out[x] = std::int8_t(rounded(value[x] / (unit * noise[x]) * per_sigma,
                                  (std::int32_t(x) + std::int32_t(odd)) & 1));
}

void flatten_steps(std::int8_t* steps, std::size_t count, bool odd, std::uint32_t dither,
                   const float middle[2], const float scale[2]) {
  constexpr float per_turn = 1.0f / 4294967296.0f;
  const float m0 = middle[0], m1 = middle[1], s0 = scale[0], s1 = scale[1];
  for (std::size_t x = 0; x < count; ++x) {
    const auto at = float(std::int32_t(x));
    const auto turn = std::int32_t(dither + std::uint32_t(x) * dither_per_pixel);
    const float flat = (float(steps[x]) - (m0 + at * m1)) * (s0 + at * s1);
    const float dithered = flat + float(turn) * per_turn;
    const std::int32_t step = rounded(dithered, (std::int32_t(x) + std::int32_t(odd)) & 1);
    steps[x] = std::int8_t(steps[x] == 0 ? 0 : step);
  }
}

}  // namespace dmise::DMISE_SIMD
