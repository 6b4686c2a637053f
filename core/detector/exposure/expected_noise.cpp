#include "core/detector/exposure/expected_noise.h"

#include <algorithm>
#include <cmath>

namespace dmise {

ElectronImage expected_noise(const ExpectedElectronImage& unshifted, const Detector& detector,
                             const Exposure& exposure, const EffectSet& effects, Threads& threads) {
  const Detector d = acting_detector(detector, effects);
  const ExpectedElectronImage smeared =
      d.frame_transfer_s > 0.0 ? d.smeared(unshifted, exposure) : ExpectedElectronImage();
  const ExpectedElectronImage& light = d.frame_transfer_s > 0.0 ? smeared : unshifted;
  ElectronImage noise(light.columns, light.rows);
  const double dark_e = d.dark_e_per_s * exposure.exposure_s;
  const float shot = d.photons_are_drawn ? 1.0f : 0.0f;
  const HotPixels& hot = d;
  const double rounding_e2 = d.gain_e_per_dn * d.gain_e_per_dn / 12.0;
  const double reading_e2 =
      d.read_noise_e * d.read_noise_e + d.column_noise_e * d.column_noise_e + rounding_e2;
  const double excess2 = d.excess_noise2() * d.shot_noise2();
  const double bend = 2.0 * d.nonlinearity / d.full_well_e;
  const auto sigma = [&](float light_e, float freed_e) {
    const double slope = std::max(0.0, 1.0 - bend * (light_e + freed_e));
    const double drawn_e2 = (shot * light_e + freed_e + d.clock_induced_e) * excess2;
    return float(std::sqrt(drawn_e2 * slope * slope + reading_e2));
  };
  constexpr std::size_t grain = 16384;
  threads.for_ranges(light.pixels.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      noise.pixels[i] = sigma(light.pixels[i], float(dark_e));
  });
  if (hot.applies(d)) {
    const RngKey key = rng_key(exposure.seed, exposure.sensor, 0, HotPixels::facts.name);
    for (const HotPixel& h : hot.among(light.pixels.size(), key))
      noise.pixels[h.pixel] =
          sigma(light.pixels[h.pixel], float(dark_e + h.dark_e_per_s * exposure.exposure_s));
  }
  if (d.reference_px > 0)
    visit_border(d.reference_px, light.columns, light.rows, 0, light.pixels.size(),
                 [&](std::size_t begin, std::size_t end) {
                   for (std::size_t i = begin; i < end; ++i) noise.pixels[i] = sigma(0.0f, 0.0f);
                 });
  if (d.is_spread()) {
    const RngKey key = rng_key(exposure.seed, exposure.sensor, 0, ReadNoise::facts.name);
    threads.for_ranges(light.pixels.size(), grain, [&](std::size_t begin, std::size_t end) {
      std::vector<float> rms_e(end - begin);
      d.rms_of_pixels(key, begin, rms_e);
      for (std::size_t i = begin; i < end; ++i) {
        const double own_e = rms_e[i - begin], mean_e = d.read_noise_e, all_e = noise.pixels[i];
        noise.pixels[i] =
            float(std::sqrt(std::max(0.0, all_e * all_e - mean_e * mean_e) + own_e * own_e));
      }
    });
  }
  return noise;
}

}  // namespace dmise
