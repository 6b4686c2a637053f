#include "core/detector/pixel_response.h"

#include <algorithm>

#include "core/detector/detector.h"
#include "core/detector/noise/detector_kernels.h"
#include "core/effects/plan_facts.h"

namespace dmise {

ErrorBound PixelResponse::error(int, const PlanFacts& f) const {
  // Pixels that sources light by half of their noise count as background, too.
  ErrorBound error = f.without_light(
      [&](const SkySample& s) { return 5.5 * prnu_rms * (s.sky_e + 0.5 * s.noise_e); });
  error.photometry_mag = 1.086 * 4.0 * prnu_rms * f.pattern_share();
  // A point's lever is its own width, a trail's half of its length over the root of three.
  const double along_px = std::max(1.0, f.fwhm_px) + 0.29 * f.longest_trail_px;
  error.position_px = 4.0 * prnu_rms * f.pattern_share(f.longest_trail_px) * along_px;
  return error;
}

double PixelResponse::cost_s(int level, const PlanFacts& f) { return level * 6.6e-9 * f.pixels(); }

std::span<const ParameterOf<PixelResponse>> PixelResponse::parameters() {
  static constexpr ParameterOf<PixelResponse> table[] = {{"prnu_rms", "PRNU",
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
