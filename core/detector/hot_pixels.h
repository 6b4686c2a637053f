#pragma once
#include <vector>

#include "core/detector/noise/detector_effect.h"

namespace dmise {

/// A pixel with excess dark current.
struct HotPixel {
  std::uint32_t pixel;
  float dark_e_per_s;
};

/// A random, fixed subset of pixels is hot. Their excess dark current is exponentially distributed
/// and adds a Poisson deviate in every frame.
struct HotPixels {
  static constexpr EffectFacts facts{"hot_pixels",
                                     "some pixels have far more dark current than others",
                                     "no false points", "exponential distribution, assumed"};
  double hot_pixel_fraction = 0.0;  // share of all pixels, 0..1
  double hot_pixel_e_per_s = 0.0;   // mean of their extra dark current at dark_reference_c
  bool operator==(const HotPixels&) const = default;

  static std::span<const ParameterOf<HotPixels>> parameters();
  void switch_off() { hot_pixel_fraction = 0.0; }
  bool applies(const Detector&) const {
    return hot_pixel_fraction > 0.0 && hot_pixel_e_per_s > 0.0;
  }
  /// Returns the hot ones among `pixels` pixels, sorted by index.
  using Prepared = std::vector<HotPixel>;
  Prepared among(std::size_t pixels, const RngKey& fixed_key) const;
  Prepared prepare(const ExposureFacts& exposed) const {
    return among(exposed.light.pixels.size(), exposed.fixed_key);
  }
  void apply(const ExposureFacts& exposed, const Prepared& hot, Piece& piece) const;
  static ErrorBound error(int, const PlanFacts&) { return not_bounded; }
  static double cost_s(int level, const PlanFacts& f);
};

}  // namespace dmise
