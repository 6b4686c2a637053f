#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/rng.h"
#include "core/detector/detector.h"

namespace dmise {

/// Charge that a cosmic ray left in a pixel.
struct CosmicCharge {
  std::uint32_t pixel;
  float electrons;
};

/// Cosmic rays of one exposure, by rising pixel: straight tracks through the sensitive layer,
/// isotropic from above, each pixel charged by the length of track within it. Landau's fluctuations
/// are left out: charge follows the length alone.
std::vector<CosmicCharge> cosmic_rays(const Detector& detector, int columns, int rows,
                                      double exposure_s, const RngKey& key);

/// Adds the charges that fall on the pixels from `first` on.
void add_cosmic_rays(std::span<const CosmicCharge> charges, std::uint32_t first,
                     std::span<float> electrons);

}  // namespace dmise
