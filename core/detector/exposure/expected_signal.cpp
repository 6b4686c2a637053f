#include "core/detector/exposure/expected_signal.h"

#include <algorithm>

#include "core/detector/exposure/chain.h"

namespace dmise {
namespace {

// Those of `DetectorEffects` that are not noise, before and after dark current is added.
using BeforeDark = EffectList<FrameTransfer, PixelResponse, BrighterFatter>;
using AfterDark =
    EffectList<HotPixels, CosmicRays, ReferencePixels, Persistence, FullWell, Blooming,
               ChargeTransfer, Nonlinearity, InterpixelCoupling, FixedPattern>;

template <class List>
void run(const ExposureFacts& exposed, Threads& threads, ElectronImage& image) {
  typename Chain<List>::Seconds seconds{};
  const Chain<List> chain(exposed, seconds);
  SaturatedPixels saturated;
  ElectronImage before;
  for (std::size_t i = 0; i < Chain<List>::size; ++i) {
    Piece piece{.first = 0,
                .electrons = std::span(image.pixels),
                .flags = {},
                .counts = nullptr,
                .saturated = &saturated};
    if (chain.reach(i) == Reach::image) {
      chain.run(i, {image, nullptr, threads, saturated}, seconds);
    } else {
      if (chain.reach(i) == Reach::neighbours) before = image;
      chain.run(i, i + 1, &before, piece, seconds);
    }
  }
}

}  // namespace

ElectronImage expected_signal(const ExpectedElectronImage& light, const Detector& parameters,
                              const Exposure& exposure, const EffectSet& effects,
                              Threads& threads) {
  const Detector detector = acting_detector(parameters, effects);
  PersistenceMemory traps;
  const ExposureFacts exposed{.light = light,
                              .detector = detector,
                              .exposure = exposure,
                              .traps = traps,
                              .level = best_simd_level(),
                              .key = {},
                              .fixed_key = {}};
  ElectronImage image(light.columns, light.rows);
  std::copy(light.pixels.begin(), light.pixels.end(), image.pixels.begin());
  run<BeforeDark>(exposed, threads, image);
  const auto dark_e = float(detector.dark_e_per_s * exposure.exposure_s);
  const auto induced_e = float(detector.clock_induced_e);
  for (float& e : image.pixels) e += dark_e + induced_e;
  run<AfterDark>(exposed, threads, image);
  return image;
}

}  // namespace dmise
