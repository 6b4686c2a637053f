#include "core/detection/known/known_stars.h"

#include <algorithm>
#include <cmath>

namespace dmise {
namespace {

double row_of(const KnownStars::Star& star) { return star.place.y_px; }

}  // namespace

KnownStars::KnownStars(const CatalogueSky& sky, const FrameHeader& header, std::vector<Star> stars,
                       BitMask lit)
    : sky_(&sky), header_(&header), stars_(std::move(stars)), lit_(std::move(lit)) {
  std::ranges::sort(stars_, {}, row_of);
}

bool KnownStars::would_know(PixelPosition place, double flux_e) const {
  return sky_ && flux_e >= complete_to_e(*sky_, *header_, place);
}

bool KnownStars::may_be_at(PixelPosition place, double within_px, double flux_e) const {
  auto star = std::ranges::lower_bound(stars_, place.y_px - within_px, {}, row_of);
  for (; star != stars_.end() && star->place.y_px <= place.y_px + within_px; ++star)
    if (star->max_e >= flux_e &&
        std::hypot(star->place.x_px - place.x_px, star->place.y_px - place.y_px) <= within_px)
      return true;
  return false;
}

}  // namespace dmise
