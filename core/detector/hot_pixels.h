#pragma once
#include <vector>

#include "core/detector/detector_effect.h"

namespace dmise {

/// A pixel with more dark current than the others.
struct HotPixel {
  std::uint32_t pixel;
  float dark_e_per_s;
};

/// Pixels that are hot with some probability and stay so. Their extra dark current is exponentially
/// distributed and gives each a Poisson deviate of its own in every frame.
struct HotPixels {
  static constexpr EffectFacts facts{"hot_pixels",
                                     "some pixels have far more dark current than the rest",
                                     "no false points", "exponential distribution, assumed"};
  double hot_pixel_fraction = 0.0;  // of all pixels, 0..1
  double hot_pixel_e_per_s = 0.0;   // mean of their extra dark current at dark_reference_c
  bool operator==(const HotPixels&) const = default;

  static std::span<const DetectorParameter> parameters();
  void switch_off() { hot_pixel_fraction = 0.0; }
  bool applies(const Detector&) const {
    return hot_pixel_fraction > 0.0 && hot_pixel_e_per_s > 0.0;
  }
  /// Those among `pixels`, by rising index.
  using Prepared = std::vector<HotPixel>;
  Prepared among(std::size_t pixels, const RngKey& fixed_key) const;
  Prepared prepare(const ExposureFacts& exposed) const {
    return among(exposed.light.pixels.size(), exposed.fixed_key);
  }
  void apply(const ExposureFacts& exposed, const Prepared& hot, Piece& piece) const;
};

}  // namespace dmise
