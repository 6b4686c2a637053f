#pragma once
#include <vector>

#include "core/sky/bodies/planets.h"
#include "core/sky/places/apparent.h"

namespace dmise {

class View;

/// Whose disc is in the field, or within `disc_margin_px` of it, in an exposure, and not wholly
/// behind the Earth.
struct BodiesInField {
  bool sun = false, moon = false, earth = false;
  bool limb = false;  // lines of sight through the air over the Earth's limb, or before its disc
  std::vector<Planet> planets;
};

/// How far beside the frame light may lie that the blur brings into it.
inline constexpr int disc_margin_px = 64;

BodiesInField bodies_in_field(const View& view);

/// Sun or Moon as a camera sees it at one time.
struct SeenBody {
  Vec<Gcrs> above_air_m;  // from the observer, aberrated, without refraction
  Vec<Gcrs> apparent;     // unit, of its centre
  double radius_rad = 0.0;
};
SeenBody seen_sun(const View& view, SimTime t);
SeenBody seen_moon(const View& view, SimTime t);
/// Sun and Moon with all effects of place that the scenario asks for, whatever was planned.
SeenBody truly_seen_sun(const View& view, SimTime t);
SeenBody truly_seen_moon(const View& view, SimTime t);

/// A rectangle of pixels, with exclusive ends, which may lie beside the frame.
struct DiscBox {
  int left = 0, top = 0, right = 0, bottom = 0;
  bool empty() const { return left >= right || top >= bottom; }
};
/// Where a disc may be at `t`, cut to the frame and a margin about it.
DiscBox box_of(const View& view, const SeenBody& body, SimTime t, int margin_px);
DiscBox frame_and_margin(const View& view, int margin_px);

}  // namespace dmise
