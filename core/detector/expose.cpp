#include "core/detector/expose.h"

#include <algorithm>
#include <chrono>
#include <mutex>
#include <optional>

#include "core/base/error.h"
#include "core/detector/dark_current.h"
#include "core/detector/detector_kernels.h"
#include "core/detector/full_well.h"
#include "core/detector/photon_noise.h"
#include "core/detector/quantisation.h"
#include "core/detector/read_noise.h"

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

}  // namespace

SaturatedPixels expose(const RateImage& light, const Detector& detector, const Exposure& exposure,
                       const EffectSet& effects, Threads& threads, CountImage& counts,
                       EffectTimes* times, SimdLevel level) {
  check(detector);
  if (light.pixels.size() > 0xffffffffu) throw Error("expose: more than 2^32 pixels");
  if (!(exposure.exposure_s >= 0.0)) throw Error("expose: exposure_s must be >= 0");
  const auto key = [&](const char* effect) {
    return rng_key(exposure.seed, exposure.sensor, exposure.frame, effect);
  };
  const RngKey photon_key = key("photon_noise"), dark_key = key("dark_current"),
               read_key = key("read_noise");
  std::optional<DarkCurrent> dark;
  if (effects.has(Effect::dark_current) && detector.dark_e_per_s > 0.0)
    dark.emplace(detector.dark_e_per_s * exposure.exposure_s);
  const bool quantised = effects.has(Effect::quantisation);
  const Adc adc{detector.gain_e_per_dn, detector.bias_dn, quantised ? detector.adc_bits : 16};

  const auto copy = kernel_of(level, sse2::copy_light, avx2::copy_light, avx512::copy_light);

  counts.columns = light.columns;
  counts.rows = light.rows;
  counts.pixels.resize(light.pixels.size());
  SaturatedPixels saturated;
  std::mutex sums;
  threads.for_ranges(light.pixels.size(), piece_px, [&](std::size_t begin, std::size_t end) {
    thread_local std::vector<float> buffer(piece_px);
    const std::span<float> e(buffer.data(), end - begin);
    const auto first = std::uint32_t(begin);
    EffectTimes spent;
    SaturatedPixels here;
    Stopwatch watch(spent);

    if (!copy(light.pixels.data() + begin, e.size(), e.data())) refuse(light, begin);
    if (effects.has(Effect::photon_noise)) photon_noise(photon_key, first, e, level);
    watch.charge(Effect::photon_noise);
    if (dark) dark->add(dark_key, first, e, level);
    watch.charge(Effect::dark_current);
    if (effects.has(Effect::full_well)) here.full_well = full_well(detector.full_well_e, e, level);
    watch.charge(Effect::full_well);
    if (effects.has(Effect::read_noise) && detector.read_noise_e > 0.0)
      read_noise(detector.read_noise_e, read_key, first, e, level);
    watch.charge(Effect::read_noise);
    here.adc = quantise(adc, e, counts.pixels.data() + begin, level);
    watch.charge(Effect::quantisation);

    std::lock_guard lock(sums);
    saturated.full_well += here.full_well;
    saturated.adc += here.adc;
    if (times)
      for (std::size_t i = 0; i < effect_count; ++i) times->seconds[i] += spent.seconds[i];
  });
  return saturated;
}

}  // namespace dmise
