#pragma once
#include <vector>

#include "core/detection/catalogue_sky.h"
#include "core/detection/scene.h"

namespace dmise {

/// How a catalogue's stars shine in a part of a frame.
struct StarLightRatio {
  double middle = 1.0;    // of their light over what is expected
  double scatter = 0.15;  // of its logarithm: scintillation, errors of the catalogue, blends
};

/// How the stars that a catalogue expects agree with a frame.
class StarAgreement {
 public:
  /// Looks for the stars in the frame, up to a few pixels off.
  StarAgreement(const Scene& scene, const FilteredFrame& frame,
                const std::vector<ExpectedStar>& stars);

  int expected() const { return expected_; }
  int found() const { return found_; }
  /// Whether the frame shows the stars, so that the catalogue's places and gaps can be relied on.
  bool holds() const { return found_ >= 1 && 10 * found_ >= 3 * expected_; }
  /// Of the frame's stars from where they are expected, and the scatter about it along one axis.
  PixelPosition shift() const { return shift_; }
  double scatter_px() const { return scatter_px_; }
  const StarLightRatio& light_at(PixelPosition place) const;

 private:
  void measure_light(const Scene& scene, const FilteredFrame& frame,
                     const std::vector<ExpectedStar>& stars);
  std::size_t cell_of(PixelPosition place) const;

  int columns_, rows_;            // of the frame
  int expected_ = 0, found_ = 0;  // of stars that are well above the noise
  PixelPosition shift_;
  double scatter_px_ = 0.3;
  std::vector<StarLightRatio> light_;  // of a mesh of cells
};

}  // namespace dmise
