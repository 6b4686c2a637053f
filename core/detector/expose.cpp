#include "core/detector/expose.h"

#include <algorithm>
#include <chrono>
#include <mutex>
#include <optional>

#include "core/base/error.h"
#include "core/detector/blooming.h"
#include "core/detector/column_noise.h"
#include "core/detector/cosmic_rays.h"
#include "core/detector/dark_current.h"
#include "core/detector/detector_kernels.h"
#include "core/detector/fixed_pattern.h"
#include "core/detector/full_well.h"
#include "core/detector/interpixel_coupling.h"
#include "core/detector/nonlinearity.h"
#include "core/detector/persistence.h"
#include "core/detector/photon_noise.h"
#include "core/detector/quantisation.h"
#include "core/detector/read_noise.h"
#include "core/detector/reference_pixels.h"

namespace dmise {
namespace {

constexpr std::size_t piece_px =
    16384;  // 64 KB of electrons: stays in the cache through all effects
static_assert(piece_px % rng_group == 0);

// Seconds of each effect; nothing of it gets into a product.
class Stopwatch {
 public:
  explicit Stopwatch(EffectTimes& times) : times_(times) { lap_ = now(); }
  void charge(Effect effect) {
    const auto t = now();
    times_[effect] += std::chrono::duration<double>(t - lap_).count();
    lap_ = t;
  }

 private:
  using Clock = std::chrono::steady_clock;
  static Clock::time_point now() { return Clock::now(); }
  EffectTimes& times_;
  Clock::time_point lap_;
};

// Names the first pixel from `begin` on that expects no number of electrons.
[[noreturn]] void refuse(const RateImage& light, std::size_t begin) {
  std::size_t i = begin;
  while (light.pixels[i] >= 0.0f && light.pixels[i] <= poisson_largest_mean) ++i;
  const auto columns = std::size_t(light.columns);
  throw Error("expose: pixel (" + std::to_string(i % columns) + ", " + std::to_string(i / columns) +
              "): expected electrons must be in 0..1e12, got " + std::to_string(light.pixels[i]));
}

// Everything of one exposure that is prepared before the first pixel.
class Chain {
 public:
  Chain(const RateImage& light, const Detector& detector, const Exposure& exposure,
        const EffectSet& effects, SimdLevel level, DetectorMemory& memory)
      : light_(light),
        d_(detector),
        exposure_(exposure),
        effects_(effects),
        level_(level),
        memory_(memory),
        copy_(kernel_of(level, sse2::copy_light, avx2::copy_light, avx512::copy_light)),
        photon_key_(key("photon_noise")),
        dark_key_(key("dark_current")),
        hot_key_(key("hot_pixels")),
        read_key_(key("read_noise")),
        response_key_(fixed("prnu")),
        adc_(effects.has(Effect::quantisation) ? Adc{d_.gain_e_per_dn, d_.bias_dn, d_.adc_bits}
                                               : Adc{}) {
    const double exposure_s = exposure.exposure_s;
    if (effects.has(Effect::dark_current)) {
      if (d_.dark_e_per_s > 0.0) dark_.emplace(d_.dark_e_per_s * exposure_s);
      hot_ = hot_pixels(d_.hot_pixel_fraction, d_.hot_pixel_e_per_s, light.pixels.size(),
                        fixed("hot_pixels"));
    }
    if (d_.cosmic_rays_per_px_s > 0.0)
      rays_ = cosmic_rays(d_, light.columns, light.rows, exposure_s, key("cosmic_rays"));
    if (d_.column_noise_e > 0.0 && effects.has(Effect::read_noise))
      columns_ = column_offsets(d_.column_noise_e, light.columns, key("column_noise"));
    if (d_.persistence_fraction > 0.0) memory_.trapped_e.resize(light.pixels.size(), 0.0f);
  }

  bool needs_neighbours() const { return d_.blooming || d_.interpixel_coupling > 0.0; }

  /// Electrons collected by the pixels from `begin` on; returns how many are full.
  std::size_t collect(std::size_t begin, std::span<float> e, Stopwatch& watch) const {
    const auto first = std::uint32_t(begin);
    if (!copy_(light_.pixels.data() + begin, e.size(), e.data())) refuse(light_, begin);
    if (d_.prnu_rms > 0.0) response_non_uniformity(d_.prnu_rms, response_key_, first, e, level_);
    const bool persistent = d_.persistence_fraction > 0.0;
    const std::span<float> trapped =
        persistent ? std::span(memory_.trapped_e).subspan(begin, e.size()) : std::span<float>();
    if (persistent)
      release_trapped(d_.persistence_s, exposure_.idle_s, exposure_.exposure_s, trapped, e);
    if (effects_.has(Effect::photon_noise)) photon_noise(photon_key_, first, e, level_);
    watch.charge(Effect::photon_noise);
    if (dark_) dark_->add(dark_key_, first, e, level_);
    add_hot_pixels(hot_, exposure_.exposure_s, hot_key_, first, e);
    add_cosmic_rays(rays_, first, e);
    if (d_.reference_px > 0)
      empty_reference_pixels(d_.reference_px, light_.columns, light_.rows, begin, e);
    watch.charge(Effect::dark_current);
    std::size_t full = 0;
    if (effects_.has(Effect::full_well) && !d_.blooming)
      full = full_well(d_.full_well_e, e, level_);
    if (persistent) trap(d_.persistence_fraction, e, trapped);
    watch.charge(Effect::full_well);
    return full;
  }

  /// Reads the pixels from `begin` on; returns how many are at the ADC's limit.
  std::size_t read(std::size_t begin, std::span<float> e, std::uint16_t* counts,
                   Stopwatch& watch) const {
    if (d_.nonlinearity > 0.0) nonlinearity(d_.nonlinearity, d_.full_well_e, e);
    if (!columns_.empty()) add_columns(columns_, begin, e);
    if (effects_.has(Effect::read_noise) && d_.read_noise_e > 0.0)
      read_noise(d_.read_noise_e, read_key_, std::uint32_t(begin), e, level_);
    watch.charge(Effect::read_noise);
    const std::size_t reached = quantise(adc_, e, counts, level_);
    watch.charge(Effect::quantisation);
    return reached;
  }

 private:
  RngKey key(const char* effect) const {
    return rng_key(exposure_.seed, exposure_.sensor, exposure_.frame, effect);
  }
  RngKey fixed(const char* effect) const {
    return fixed_key(exposure_.seed, exposure_.sensor, effect);
  }

  const RateImage& light_;
  const Detector& d_;
  const Exposure& exposure_;
  const EffectSet& effects_;
  SimdLevel level_;
  DetectorMemory& memory_;
  bool (*copy_)(const float*, std::size_t, float*);
  RngKey photon_key_, dark_key_, hot_key_, read_key_, response_key_;
  Adc adc_;
  std::optional<DarkCurrent> dark_;
  std::vector<HotPixel> hot_;
  std::vector<CosmicCharge> rays_;
  std::vector<float> columns_;
};

}  // namespace

SaturatedPixels expose(const RateImage& light, const Detector& detector, const Exposure& exposure,
                       const EffectSet& effects, Threads& threads, CountImage& counts,
                       EffectTimes* times, SimdLevel level, DetectorMemory* memory) {
  check(detector);
  if (light.pixels.size() > 0xffffffffu) throw Error("expose: more than 2^32 pixels");
  if (!(exposure.exposure_s >= 0.0)) throw Error("expose: exposure_s must be >= 0");
  counts.columns = light.columns;
  counts.rows = light.rows;
  counts.pixels.resize(light.pixels.size());
  DetectorMemory own;
  DetectorMemory& kept = memory ? *memory : own;
  const Chain chain(light, detector, exposure, effects, level, kept);

  SaturatedPixels saturated;
  std::mutex sums;
  // Runs work(begin, electrons, watch) on every piece and sums what it returns.
  const auto by_pieces = [&](const auto& work) {
    threads.for_ranges(light.pixels.size(), piece_px, [&](std::size_t begin, std::size_t end) {
      thread_local std::vector<float> buffer(piece_px);
      EffectTimes spent;
      Stopwatch watch(spent);
      const SaturatedPixels here = work(begin, std::span(buffer.data(), end - begin), watch);
      std::lock_guard lock(sums);
      saturated.full_well += here.full_well;
      saturated.adc += here.adc;
      if (times)
        for (std::size_t i = 0; i < effect_count; ++i) times->seconds[i] += spent.seconds[i];
    });
  };

  if (!chain.needs_neighbours()) {
    by_pieces([&](std::size_t begin, std::span<float> e, Stopwatch& watch) {
      const std::size_t full = chain.collect(begin, e, watch);
      return SaturatedPixels{full, chain.read(begin, e, counts.pixels.data() + begin, watch)};
    });
    return saturated;
  }

  ElectronImage& collected = kept.electrons;
  collected.columns = light.columns;
  collected.rows = light.rows;
  collected.pixels.resize(light.pixels.size());
  by_pieces([&](std::size_t begin, std::span<float> e, Stopwatch& watch) {
    const auto part = std::span(collected.pixels).subspan(begin, e.size());
    return SaturatedPixels{chain.collect(begin, part, watch), 0};
  });
  if (detector.blooming && effects.has(Effect::full_well))
    saturated.full_well = blooming(detector.full_well_e, collected, threads);
  by_pieces([&](std::size_t begin, std::span<float> e, Stopwatch& watch) {
    interpixel_coupling(detector.interpixel_coupling, collected, begin, e);
    return SaturatedPixels{0, chain.read(begin, e, counts.pixels.data() + begin, watch)};
  });
  return saturated;
}

}  // namespace dmise
