#pragma once
#include <array>
#include <vector>

#include "core/detection/pixels/bit_mask.h"
#include "core/detection/source/scene.h"

namespace dmise {

/// A star that a frame shows as a trail of the length and direction of all stars there.
struct TrailedStar {
  Trail trail;
  std::array<double, 3> covariance_px2{};  // xx, xy, yy of its middle
  double flux_sigma_e = 0.0;
};

/// Whether stars trail by so much that their shape alone tells them from points.
bool stars_trail(const Scene& scene);
/// Whether by so much that no short streak looks like them.
bool stars_trail_far(const Scene& scene);

/// Finds stars without a catalogue, where they trail: light that is even along the common trail and
/// ends with it. Light that stands out of a part of a trail, as of an object before it, is left.
/// Middles may be beside the frame. Returns none if the search exceeds its bound, which counts
/// reads of pixels and does not depend on the machine.
std::vector<TrailedStar> find_trailed_stars(const Scene& scene);

/// A frame less its stars.
struct StarlessFrame {
  CountImage counts;
  BitMask lit;  // pixels that the stars' photons and the errors of their light make much noisier
};

StarlessFrame without_stars(const Scene& scene, const std::vector<TrailedStar>& stars);

}  // namespace dmise
