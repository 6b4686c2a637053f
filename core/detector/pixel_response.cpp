#include "core/detector/pixel_response.h"

#include <algorithm>

#include "core/detector/detector.h"
#include "core/detector/detector_kernels.h"

namespace dmise {

std::span<const DetectorParameter> PixelResponse::parameters() {
  static constexpr DetectorParameter table[] = {{"prnu_rms", "PRNU",
                                                 "rms of the pixels' responses, relative",
                                                 &PixelResponse::prnu_rms, 0.0, 0.2}};
  return table;
}

void PixelResponse::apply(const ExposureFacts& exposed, Piece& piece) const {
  const auto add_normal =
      kernel_of(exposed.level, sse2::add_normal, avx2::add_normal, avx512::add_normal);
  constexpr std::size_t part = 1024;
  float response[part];
  const auto light_e = piece.electrons;
  for (std::size_t i = 0; i < light_e.size(); i += part) {
    const std::size_t n = std::min(part, light_e.size() - i);
    std::fill_n(response, n, 1.0f);
    add_normal(exposed.fixed_key, std::uint32_t(piece.first + i), float(prnu_rms), response, n);
    for (std::size_t j = 0; j < n; ++j) light_e[i + j] *= std::max(0.0f, response[j]);
  }
}

}  // namespace dmise
