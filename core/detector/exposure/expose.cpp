#include "core/detector/exposure/expose.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <string>

#include "core/base/error.h"
#include "core/detector/exposure/chain.h"
#include "core/detector/noise/detector_kernels.h"
#include "core/detector/noise/poisson.h"

namespace dmise {
namespace {

using DetectorChain = Chain<DetectorEffects>;

// 64 KB of electrons, which stay in the cache through all effects.
constexpr std::size_t piece_px = 16384;
static_assert(piece_px % rng_group == 0);

void check(const ExpectedElectronImage& light, const Exposure& exposure) {
  if (light.pixels.size() > 0xffffffffu) throw Error("expose: more than 2^32 pixels");
  if (!(exposure.exposure_s >= 0.0)) throw Error("expose: exposure_s must be >= 0");
  if (!(exposure.idle_s >= 0.0)) throw Error("expose: idle_s must be >= 0");
}

/// Throws an error that names the first pixel from `begin` on without a valid expectation.
[[noreturn]] void refuse(const ExpectedElectronImage& light, std::size_t begin) {
  std::size_t i = begin;
  while (light.pixels[i] >= 0.0f && std::isfinite(light.pixels[i])) ++i;
  const auto columns = std::size_t(light.columns);
  throw Error("expose: pixel (" + std::to_string(i % columns) + ", " + std::to_string(i / columns) +
              "): expected electrons must be finite and >= 0, got " +
              std::to_string(light.pixels[i]));
}

void take_light(const ExpectedElectronImage& light, Piece& piece, SimdLevel level) {
  const auto copy = kernel_of(level, sse2::copy_light, avx2::copy_light, avx512::copy_light);
  if (!copy(light.pixels.data() + piece.first, piece.electrons.size(), piece.electrons.data()))
    refuse(light, piece.first);
  std::fill(piece.flags.begin(), piece.flags.end(), std::uint8_t{0});
}

template <class AnImage>
void resize_like(const ExpectedElectronImage& light, AnImage& image) {
  image.columns = light.columns;
  image.rows = light.rows;
  image.pixels.resize(light.pixels.size());
}

}  // namespace

SaturatedPixels expose(const ExpectedElectronImage& light, const Detector& parameters,
                       const Exposure& exposure, const EffectSet& effects, Threads& threads,
                       CountImage& counts, EffectTimes* times, const ExposeOptions& options) {
  dmise::check(parameters);
  check(light, exposure);
  const Detector detector = drawn_together(acting_detector(parameters, effects), effects);
  resize_like(light, counts);
  if (options.flags) resize_like(light, *options.flags);
  DetectorMemory own;
  DetectorMemory& kept = options.memory ? *options.memory : own;
  ElectronImage& image = kept.electrons;

  SaturatedPixels saturated;
  DetectorChain::Seconds seconds{};
  const DetectorChain chain({.light = light,
                             .detector = detector,
                             .exposure = exposure,
                             .traps = kept.persistence,
                             .level = options.level,
                             .key = {},
                             .fixed_key = {}},
                            seconds);
  std::mutex sums;
  ElectronImage before;  // what a piece's neighbours had, where the image itself is written
  const auto on_pieces = [&](std::size_t begin, std::size_t end, bool first, bool by_neighbours) {
    const bool in_buffer = end == DetectorChain::size && (first || by_neighbours);
    if (by_neighbours && !in_buffer) before = image;
    const ElectronImage& around = in_buffer ? image : before;
    threads.for_ranges(light.pixels.size(), piece_px, [&](std::size_t from, std::size_t to) {
      thread_local std::vector<float> buffer(piece_px);
      DetectorChain::Seconds spent{};
      SaturatedPixels here;
      Piece piece{
          .first = from,
          .electrons = (in_buffer ? std::span(buffer) : std::span(image.pixels).subspan(from))
                           .first(to - from),
          .flags = options.flags ? std::span(options.flags->pixels).subspan(from, to - from)
                                 : std::span<std::uint8_t>(),
          .counts = counts.pixels.data() + from,
          .saturated = &here};
      if (first) take_light(light, piece, options.level);
      chain.run(begin, end, &around, piece, spent);
      std::lock_guard lock(sums);
      saturated.full_well += here.full_well;
      saturated.adc += here.adc;
      for (std::size_t i = 0; i < spent.size(); ++i) seconds[i] += spent[i];
    });
  };

  // Pieces run up to the next effect that needs more of the image.
  std::size_t end = chain.next_beyond_pieces(0);
  if (end < DetectorChain::size) resize_like(light, image);
  on_pieces(0, end, true, false);
  while (end < DetectorChain::size) {
    std::size_t begin = end;
    if (chain.reach(begin) == Reach::image)
      chain.run(begin++, {image, options.flags, threads, saturated}, seconds);
    const bool by_neighbours = chain.reach(begin) == Reach::neighbours;
    end = chain.next_beyond_pieces(begin + by_neighbours);
    on_pieces(begin, end, false, by_neighbours);
  }
  if (times) chain.record(seconds, *times);
  return saturated;
}

}  // namespace dmise
