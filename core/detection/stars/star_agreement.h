#pragma once
#include <vector>

#include "core/detection/known/catalogue_sky.h"
#include "core/detection/known/stars_seen.h"
#include "core/detection/source/scene.h"

namespace dmise {

/// Light of a catalogue's stars in a part of a frame.
struct StarLightRatio {
  double middle = 1.0;    // median of their light over what is expected
  double scatter = 0.15;  // in the logarithm: scintillation, errors of the catalogue, blends
};

/// How the stars that a catalogue expects agree with a frame. Variable stars take no part.
class StarAgreement {
 public:
  /// Looks for the stars in the frame, up to a few pixels off.
  StarAgreement(const Scene& scene, const FilteredFrame& frame,
                const std::vector<ExpectedStar>& stars);

  const StarsSeen& seen() const { return seen_; }
  const StarLightRatio& light_at(PixelPosition place) const;

 private:
  void measure_light(const Scene& scene, const FilteredFrame& frame,
                     const std::vector<ExpectedStar>& stars);
  std::size_t cell_of(PixelPosition place) const;

  int columns_, rows_;  // the frame's size
  StarsSeen seen_;
  std::vector<StarLightRatio> light_;  // by cells of a mesh over the frame
};

}  // namespace dmise
