#include "core/detector/chain.h"

#include <algorithm>
#include <array>
#include <string>

#include "core/base/error.h"
#include "core/detector/column_noise.h"
#include "core/detector/detector_kernels.h"
#include "core/detector/full_well.h"
#include "core/detector/nonlinearity.h"
#include "core/detector/photon_noise.h"
#include "core/detector/poisson.h"
#include "core/detector/read_noise.h"
#include "core/detector/reference_pixels.h"

namespace dmise {
namespace {

// Names the first pixel from `begin` on that expects no number of electrons.
[[noreturn]] void refuse(const RateImage& light, std::size_t begin) {
  std::size_t i = begin;
  while (light.pixels[i] >= 0.0f && light.pixels[i] <= poisson_largest_mean) ++i;
  const auto columns = std::size_t(light.columns);
  throw Error("expose: pixel (" + std::to_string(i % columns) + ", " + std::to_string(i / columns) +
              "): expected electrons must be in 0..1e12, got " + std::to_string(light.pixels[i]));
}

// Sets `flag` in the pixels from `begin` on that a list sorted by pixel names.
template <class Item>
void flag_listed(const std::vector<Item>& items, std::size_t begin, PixelFlag flag,
                 std::span<std::uint8_t> flags) {
  auto it = std::lower_bound(items.begin(), items.end(), begin,
                             [](const Item& item, std::size_t p) { return item.pixel < p; });
  for (; it != items.end() && it->pixel - begin < flags.size(); ++it)
    flags[it->pixel - begin] |= flag;
}

}  // namespace

Chain::Chain(const RateImage& light, const Detector& detector, const Exposure& exposure,
             const EffectSet& effects, PersistenceMemory& traps, SimdLevel level,
             EffectWatch& watch)
    : light_(light),
      d_(detector),
      exposure_(exposure),
      effects_(effects),
      traps_(traps),
      level_(level) {
  const auto stream = [&](const char* effect) {
    return rng_key(exposure.seed, exposure.sensor, exposure.frame, effect);
  };
  const auto fixed = [&](const char* effect) {
    return fixed_key(exposure.seed, exposure.sensor, effect);
  };
  keys_ = {.photons = stream("photon_noise"),
           .dark = stream("dark_current"),
           .hot = stream("hot_pixels"),
           .released = stream("persistence"),
           .read = stream("read_noise"),
           .response = fixed("prnu")};
  if (on(Effect::dark_current)) {
    dark_.emplace(d_.dark_e_per_s * exposure.exposure_s);
    watch.charge(Effect::dark_current);
  }
  if (on(Effect::hot_pixels)) {
    hot_ = hot_pixels(d_.hot_pixel_fraction, d_.hot_pixel_e_per_s, light.pixels.size(),
                      fixed("hot_pixels"));
    watch.charge(Effect::hot_pixels);
  }
  if (on(Effect::cosmic_rays)) {
    rays_ = cosmic_rays(d_, light.columns, light.rows, exposure.exposure_s, stream("cosmic_rays"));
    watch.charge(Effect::cosmic_rays);
  }
  if (on(Effect::column_noise)) {
    columns_ = column_offsets(d_.column_noise_e, light.columns, stream("column_noise"));
    watch.charge(Effect::column_noise);
  }
  if (on(Effect::persistence)) {
    release_.emplace(d_.persistence_s, exposure.idle_s, exposure.exposure_s);
    const double cadence_s = exposure.exposure_s + exposure.idle_s;
    begin_frame(traps_, exposure.frame, persistence_window(d_.persistence_s, cadence_s),
                light.pixels.size());
    watch.charge(Effect::persistence);
  }
}

std::size_t Chain::collect(std::size_t begin, std::span<float> e, std::span<std::uint8_t> flags,
                           EffectWatch& watch) const {
  const auto first = std::uint32_t(begin);
  const auto copy = kernel_of(level_, sse2::copy_light, avx2::copy_light, avx512::copy_light);
  if (!copy(light_.pixels.data() + begin, e.size(), e.data())) refuse(light_, begin);
  if (on(Effect::prnu)) {
    response_non_uniformity(d_.prnu_rms, keys_.response, first, e, level_);
    watch.charge(Effect::prnu);
  }
  if (on(Effect::photon_noise)) photon_noise(keys_.photons, first, e, level_);
  watch.charge(Effect::photon_noise);
  if (dark_) {
    dark_->add(keys_.dark, first, e, level_);
    watch.charge(Effect::dark_current);
  }
  if (!hot_.empty()) {
    add_hot_pixels(hot_, exposure_.exposure_s, keys_.hot, first, e);
    watch.charge(Effect::hot_pixels);
  }
  if (!rays_.empty()) {
    add_cosmic_rays(rays_, first, e);
    watch.charge(Effect::cosmic_rays);
  }
  if (!flags.empty()) {
    std::fill(flags.begin(), flags.end(), std::uint8_t{0});
    flag_listed(hot_, begin, flag_hot, flags);
    flag_listed(rays_, begin, flag_cosmic_ray, flags);
  }
  if (on(Effect::reference_pixels)) {
    empty_reference_pixels(d_.reference_px, light_.columns, light_.rows, begin, e, flags);
    watch.charge(Effect::reference_pixels);
  }
  if (release_) {
    collect_released(begin, e);
    watch.charge(Effect::persistence);
  }
  if (d_.blooming || !on(Effect::full_well)) return 0;
  const std::size_t full = full_well(d_.full_well_e, e, level_);
  if (!flags.empty() && full > 0)
    for (std::size_t i = 0; i < e.size(); ++i)
      if (e[i] >= float(d_.full_well_e)) flags[i] |= flag_full_well;
  watch.charge(Effect::full_well);
  return full;
}

void Chain::collect_released(std::size_t begin, std::span<float> e) const {
  const auto trapped = std::span(traps_.trapped_e).subspan(begin, e.size());
  const auto younger = traps_.younger_e.empty()
                           ? std::span<float>()
                           : std::span(traps_.younger_e).subspan(begin, e.size());
  release_->apply(younger);
  if (!younger.empty()) trap(d_.persistence_fraction, d_.full_well_e, e, younger);
  constexpr std::size_t piece = 1024;
  static_assert(piece % rng_group == 0);
  std::array<float, piece> released;
  for (std::size_t i = 0; i < e.size(); i += piece) {
    const std::size_t n = std::min(piece, e.size() - i);
    const auto here = trapped.subspan(i, n);
    release_->apply(here, std::span(released).first(n));
    trap(d_.persistence_fraction, d_.full_well_e, e.subspan(i, n), here);
    if (on(Effect::photon_noise))
      poisson(keys_.released, std::uint32_t(begin + i), released.data(), n, released.data(),
              level_);
    for (std::size_t j = 0; j < n; ++j) e[i + j] += released[j];
  }
}

std::size_t Chain::read(std::size_t begin, std::span<float> e, std::uint16_t* counts,
                        std::span<std::uint8_t> flags, EffectWatch& watch) const {
  if (on(Effect::nonlinearity)) {
    nonlinearity(d_.nonlinearity, d_.full_well_e, e);
    watch.charge(Effect::nonlinearity);
  }
  if (!columns_.empty()) {
    add_columns(columns_, begin, e);
    watch.charge(Effect::column_noise);
  }
  if (on(Effect::read_noise)) {
    read_noise(d_.read_noise_e, keys_.read, std::uint32_t(begin), e, level_);
    watch.charge(Effect::read_noise);
  }
  const std::size_t reached =
      quantise({d_.gain_e_per_dn, d_.bias_dn, d_.adc_bits}, e, counts, level_);
  if (!flags.empty()) {
    const int highest = (1 << d_.adc_bits) - 1;
    for (std::size_t i = 0; i < flags.size(); ++i) {
      const int high = counts[i] == highest ? flag_adc_high : 0;
      flags[i] = std::uint8_t(flags[i] | high | (counts[i] == 0 ? flag_adc_low : 0));
    }
  }
  watch.charge(Effect::quantisation);
  return reached;
}

}  // namespace dmise
