#pragma once
#include <limits>
#include <memory>
#include <vector>

#include "core/base/pixel.h"
#include "core/detection/known/expected_star.h"
#include "core/products/frame_header.h"
#include "core/sky/stars/star_map.h"

namespace dmise {

/// A catalogue of stars for detection. A source at the place of one of its stars is that star; a
/// source elsewhere that is bright enough for the catalogue is no star.
class CatalogueSky {
 public:
  explicit CatalogueSky(std::shared_ptr<const StarMap> map);

  /// V to which the catalogue is taken as complete: a magnitude brighter than where its counts
  /// begin to fall.
  double complete_to_v_mag() const { return complete_to_v_mag_; }

  /// Whether enough is known of a frame to expect stars at their places with their light.
  static bool can_expect(const UnknownFacts& unknown);

  /// Returns the stars of at least `min_signal_e` in a frame and up to `beyond_px` beside it, by
  /// the header's WCS, zero point, band and air, without noise and clouds. In the catalogue's
  /// order. None unless `can_expect`.
  std::vector<ExpectedStar> stars_in(const FrameHeader& header, int columns, int rows,
                                     double min_signal_e, double beyond_px = 20.0) const;

 private:
  std::shared_ptr<const StarMap> map_;
  double complete_to_v_mag_ = -std::numeric_limits<double>::infinity();
};

/// Returns the light [e-] above which the catalogue has every star, at a pixel of a frame.
double complete_to_e(const CatalogueSky& sky, const FrameHeader& header, PixelPosition pixel);

}  // namespace dmise
