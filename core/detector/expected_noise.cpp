#include "core/detector/expected_noise.h"

#include <cmath>
#include <vector>

#include "core/detector/fixed_pattern.h"
#include "core/detector/reference_pixels.h"

namespace dmise {

ElectronImage expected_noise(const RateImage& light, const Detector& figures,
                             const Exposure& exposure, const EffectSet& effects, Threads& threads) {
  const Detector d = in_effect(figures, effects);
  ElectronImage noise(light.columns, light.rows);
  const double dark_e = d.dark_e_per_s * exposure.exposure_s;
  const float shot = effects.has(Effect::photon_noise) ? 1.0f : 0.0f;
  const std::vector<HotPixel> hot =
      has_figure(d, Effect::hot_pixels)
          ? hot_pixels(d.hot_pixel_fraction, d.hot_pixel_e_per_s, light.pixels.size(),
                       fixed_key(exposure.seed, exposure.sensor, "hot_pixels"))
          : std::vector<HotPixel>();
  const double rounding_e2 = d.gain_e_per_dn * d.gain_e_per_dn / 12.0;
  const double reading_e2 =
      d.read_noise_e * d.read_noise_e + d.column_noise_e * d.column_noise_e + rounding_e2;
  const double bend = 2.0 * d.nonlinearity / d.full_well_e;
  const auto sigma = [&](float light_e, float freed_e) {
    const double slope = std::max(0.0, 1.0 - bend * (light_e + freed_e));
    return float(std::sqrt((shot * light_e + freed_e) * slope * slope + reading_e2));
  };
  constexpr std::size_t grain = 16384;
  threads.for_ranges(light.pixels.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      noise.pixels[i] = sigma(light.pixels[i], float(dark_e));
  });
  for (const HotPixel& h : hot)
    noise.pixels[h.pixel] =
        sigma(light.pixels[h.pixel], float(dark_e + h.dark_e_per_s * exposure.exposure_s));
  if (d.reference_px > 0) {
    std::vector<std::uint8_t> border(light.pixels.size());
    std::vector<float> unused(light.pixels.size());
    empty_reference_pixels(d.reference_px, light.columns, light.rows, 0, unused, border);
    for (std::size_t i = 0; i < border.size(); ++i)
      if (border[i]) noise.pixels[i] = float(std::sqrt(reading_e2));
  }
  return noise;
}

}  // namespace dmise
