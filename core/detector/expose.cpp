#include "core/detector/expose.h"

#include <mutex>
#include <span>

#include "core/base/error.h"
#include "core/detector/blooming.h"
#include "core/detector/chain.h"
#include "core/detector/effect_watch.h"
#include "core/detector/interpixel_coupling.h"

namespace dmise {
namespace {

constexpr std::size_t piece_px =
    16384;  // 64 KB of electrons: stays in the cache through all effects
static_assert(piece_px % rng_group == 0);

void check(const RateImage& light, const Detector& d, const Exposure& exposure) {
  if (light.pixels.size() > 0xffffffffu) throw Error("expose: more than 2^32 pixels");
  if (!(exposure.exposure_s >= 0.0)) throw Error("expose: exposure_s must be >= 0");
  if (!(exposure.idle_s >= 0.0)) throw Error("expose: idle_s must be >= 0");
  const double hits = d.cosmic_rays_per_px_s * exposure.exposure_s * double(light.pixels.size());
  if (hits > most_cosmic_hits)
    throw Error("detector.cosmic_rays_per_px_s: an exposure must expect <= 1e7 hits, got " +
                std::to_string(hits));
}

}  // namespace

SaturatedPixels expose(const RateImage& light, const Detector& figures, const Exposure& exposure,
                       const EffectSet& effects, Threads& threads, CountImage& counts,
                       EffectTimes* times, const ExposeOptions& options) {
  dmise::check(figures);
  const Detector detector = in_effect(figures, effects);
  check(light, detector, exposure);
  counts.columns = light.columns;
  counts.rows = light.rows;
  counts.pixels.resize(light.pixels.size());
  if (options.flags) {
    options.flags->columns = light.columns;
    options.flags->rows = light.rows;
    options.flags->pixels.resize(light.pixels.size());
  }
  const auto flags_of = [&](std::size_t begin, std::size_t size) {
    return options.flags ? std::span(options.flags->pixels).subspan(begin, size)
                         : std::span<std::uint8_t>();
  };
  DetectorMemory own;
  DetectorMemory& kept = options.memory ? *options.memory : own;

  SaturatedPixels saturated;
  EffectTimes all;
  EffectWatch preparing(all);
  const Chain chain(light, detector, exposure, effects, kept.persistence, options.level, preparing);
  std::mutex sums;
  // Runs work(begin, electrons, watch) on every piece and sums what it returns.
  const auto by_pieces = [&](const auto& work) {
    threads.for_ranges(light.pixels.size(), piece_px, [&](std::size_t begin, std::size_t end) {
      thread_local std::vector<float> buffer(piece_px);
      EffectTimes spent;
      EffectWatch watch(spent);
      const SaturatedPixels here = work(begin, std::span(buffer.data(), end - begin), watch);
      std::lock_guard lock(sums);
      saturated.full_well += here.full_well;
      saturated.adc += here.adc;
      for (std::size_t i = 0; i < effect_count; ++i) all.seconds[i] += spent.seconds[i];
    });
  };
  const auto read = [&](std::size_t begin, std::span<float> e, EffectWatch& watch) {
    return chain.read(begin, e, counts.pixels.data() + begin, flags_of(begin, e.size()), watch);
  };

  const auto collect = [&](std::size_t begin, std::span<float> e, EffectWatch& watch) {
    return chain.collect(begin, e, flags_of(begin, e.size()), watch);
  };

  if (!chain.needs_neighbours()) {
    by_pieces([&](std::size_t begin, std::span<float> e, EffectWatch& watch) {
      const std::size_t full = collect(begin, e, watch);
      return SaturatedPixels{full, read(begin, e, watch)};
    });
  } else {
    ElectronImage& collected = kept.electrons;
    collected.columns = light.columns;
    collected.rows = light.rows;
    collected.pixels.resize(light.pixels.size());
    by_pieces([&](std::size_t begin, std::span<float> e, EffectWatch& watch) {
      const auto part = std::span(collected.pixels).subspan(begin, e.size());
      return SaturatedPixels{collect(begin, part, watch), 0};
    });
    if (detector.blooming) {
      EffectWatch watch(all);
      saturated.full_well = blooming(detector.full_well_e, collected, threads, options.flags);
      watch.charge(Effect::blooming);
    }
    by_pieces([&](std::size_t begin, std::span<float> e, EffectWatch& watch) {
      if (detector.interpixel_coupling > 0.0) {
        interpixel_coupling(detector.interpixel_coupling, collected, begin, e);
        watch.charge(Effect::interpixel_coupling);
      } else {
        e = std::span(collected.pixels).subspan(begin, e.size());
      }
      return SaturatedPixels{0, read(begin, e, watch)};
    });
  }
  if (times)
    for (std::size_t i = 0; i < effect_count; ++i) times->seconds[i] += all.seconds[i];
  return saturated;
}

}  // namespace dmise
