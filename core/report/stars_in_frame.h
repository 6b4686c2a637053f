#pragma once
#include <cstdint>
#include <vector>

#include "core/base/pixel.h"
#include "core/sky/stars/star_map.h"
#include "core/wcs/wcs.h"

namespace dmise {

struct StarInFrame {
  std::uint32_t id = 0;  // in the catalogue
  PixelPosition pixel;
  double ra_rad = 0.0, dec_rad = 0.0;  // ICRS, of the date
  double v_mag = 0.0;
};

/// The brightest stars of a catalogue that lie in an image, at most `most`, brightest first.
/// `jyear`: of the exposure.
std::vector<StarInFrame> stars_in_frame(const StarMap& map, const Wcs& wcs, int columns, int rows,
                                        double jyear, std::size_t most);

}  // namespace dmise
