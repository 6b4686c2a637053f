#include "core/detection/stars/hide_stars.h"

#include <algorithm>
#include <cmath>

#include "core/base/numeric/simd_level.h"
#include "core/detection/light/star_image.h"
#include "core/detection/pixels/components.h"
#include "core/detection/stars/shown_stars.h"
#include "core/detection/stars/star_agreement.h"

namespace dmise {
namespace {

constexpr double subtracted_snr = 0.4;  // least light of a star, and in a pixel, that is subtracted
constexpr double max_trail_px = 500.0;  // longer ones are streaks of their own, not stars
constexpr double spare_px = 20.0;       // beside the frame, from where light of stars comes in
constexpr double hidden_snr = 5.0;      // light of which too much may be left
constexpr double lit_noise = 0.4;       // light in a pixel [its noise] that a fit must not take
// By how many sigmas of its scatter a star may be brighter than expected: when its light is hidden,
// and when it is compared with a source.
constexpr double subtracted_sigmas = 3.0, max_sigmas = 7.0;
// Scatter from which on any star may be as bright as any source.
constexpr double flickering = 0.35;

/// Subtracts a star from the filtered frame, and hides where more than `hidden` of it is.
void subtract(const StarImage& image, float hidden, FilteredFrame& frame) {
  static const auto subtract_light = kernel_of(best_simd_level(), sse2::subtract_light,
                                               avx2::subtract_light, avx512::subtract_light);
  for (int y = image.y0; y <= image.y1; ++y)
    subtract_light(image.row(y), hidden, image.width(), (image.x0 + y) % 2 != 0,
                   frame.row(y) + image.x0);
}

void mark(const StarImage& image, float least, BitMask& lit) {
  static const auto bits_above =
      kernel_of(best_simd_level(), sse2::bits_above, avx2::bits_above, avx512::bits_above);
  constexpr int word = 64;
  for (int y = image.y0; y <= image.y1; ++y)
    for (int x = image.x0; x <= image.x1; x += word)
      lit.set_bits(x, y,
                   bits_above(image.row(y) + (x - image.x0),
                              std::size_t(std::min(word, image.x1 - x + 1)), least));
}

}  // namespace

std::optional<KnownStars> hide_stars(const Scene& scene, FilteredFrame& frame,
                                     const CatalogueSky& sky, const FrameHeader& header,
                                     StarsSeen& seen) {
  const double unit = std::sqrt(kernel_square_sum(frame.sigma_px));
  // The light of the faintest star that is subtracted, also where noise is half of the middle.
  const double min_e =
      0.5 * subtracted_snr * scene.background.median_sigma_dn() * scene.gain_e_per_dn / unit;
  if (!(min_e > 0)) return std::nullopt;
  const double longest_px = scene.stars.longest_trail_px();
  if (longest_px > max_trail_px) return std::nullopt;
  const double beyond_px = spare_px + 0.5 * longest_px;
  auto expected = sky.stars_in(header, frame.columns, frame.rows, min_e, beyond_px);
  const StarAgreement agreement(scene, frame, expected);
  seen = agreement.seen();
  if (!seen.agree()) return std::nullopt;
  const auto planets = ExpectedStars(header, frame.columns, frame.rows, min_e, beyond_px).planets();
  expected.insert(expected.end(), planets.begin(), planets.end());
  BitMask lit(frame.columns, frame.rows);
  std::vector<KnownStars::Star> stars;
  stars.reserve(expected.size());
  StarImage image(frame.columns, frame.rows);
  const auto shown = shown_stars(scene, agreement, expected);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const ShownStar& star = shown[i];
    const PixelPosition at{star.trail.x_px, star.trail.y_px};
    const double in_noise = star.flux_e / star.noise_e;
    const double hidden = hidden_snr / (std::exp(subtracted_sigmas * star.light_error) * star.most);
    const double sigma_px = std::hypot(scene.psf.sigma_at(at), 0.5 * expected[i].radius_px);
    image.draw(star.trail, std::hypot(sigma_px, frame.sigma_px), in_noise / unit,
               std::min(subtracted_snr, hidden));
    subtract(image, float(hidden), frame);
    image.draw(star.trail, sigma_px, in_noise, lit_noise);
    mark(image, float(lit_noise), lit);
    const PixelPosition expected_at = expected[i].place + seen.shift;
    const StarLightRatio& light = agreement.light_at(expected_at);
    const double most =
        light.scatter > flickering ? HUGE_VAL : std::exp(max_sigmas * light.scatter);
    stars.push_back({expected_at, light.middle * expected[i].signal_e * most * expected[i].most});
  }
  return KnownStars(sky, header, std::move(stars), std::move(lit));
}

}  // namespace dmise
