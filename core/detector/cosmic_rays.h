#pragma once
#include <vector>

#include "core/detector/noise/detector_effect.h"

namespace dmise {

/// Charge deposited by a cosmic ray in a pixel.
struct CosmicCharge {
  std::uint32_t pixel;
  float electrons;
  float time = 0.0f;  // when it came, of the exposure: [0, 1)
};

/// Limit on the number of hits in one exposure.
inline constexpr double max_cosmic_hits = 1e7;

/// Straight tracks through the sensitive layer, isotropic from above; each pixel is charged by the
/// track length inside it. Landau fluctuations are neglected.
struct CosmicRays {
  static constexpr EffectFacts facts{"cosmic_rays", "charged particles leave tracks",
                                     "no false points and streaks",
                                     "geometry of isotropic flux through a slab"};
  double cosmic_rays_per_px_s = 0.0;    // hits
  double cosmic_ray_e_per_px = 1000.0;  // charge per pixel pitch of track
  double cosmic_ray_depth_px = 1.0;     // depth of the sensitive layer in pixel pitches
  bool operator==(const CosmicRays&) const = default;

  static std::span<const ParameterOf<CosmicRays>> parameters();
  void switch_off() { cosmic_rays_per_px_s = 0.0; }
  bool applies(const Detector&) const {
    return cosmic_rays_per_px_s > 0.0 && cosmic_ray_e_per_px > 0.0;
  }
  /// Charges of one exposure, sorted by pixel.
  using Prepared = std::vector<CosmicCharge>;
  Prepared charges(int columns, int rows, double exposure_s, const RngKey& key) const;
  /// Throws `Error` if more than `max_cosmic_hits` hits are expected.
  Prepared prepare(const ExposureFacts& exposed) const;
  void apply(const ExposureFacts& exposed, const Prepared& charges, Piece& piece) const;
  static ErrorBound error(int, const PlanFacts&) { return not_bounded; }
  static double cost_s(int level, const PlanFacts& f);
};

}  // namespace dmise
