#include "core/sky/places/star_place.h"

#include <cmath>

namespace dmise {

CataloguedStar::CataloguedStar(const StarPlace& place) : star(place) {
  const double sin_ra = std::sin(place.ra_rad), cos_ra = std::cos(place.ra_rad);
  const double sin_dec = std::sin(place.dec_rad), cos_dec = std::cos(place.dec_rad);
  outward = {cos_ra * cos_dec, sin_ra * cos_dec, sin_dec};
  east = {-sin_ra, cos_ra, 0.0};
  north = {-cos_ra * sin_dec, -sin_ra * sin_dec, cos_dec};
}

CataloguedStar::CataloguedStar(const StarPlace& place, const Vec<Gcrs>& direction)
    : star(place), outward(direction) {
  const double from_axis = std::sqrt(direction.x * direction.x + direction.y * direction.y);
  constexpr double at_the_pole = 1e-9;  // rounding turns east there
  if (from_axis < at_the_pole) {
    east = {-std::sin(place.ra_rad), std::cos(place.ra_rad), 0.0};
  } else {
    const double per_axis = 1.0 / from_axis;
    east = {-direction.y * per_axis, direction.x * per_axis, 0.0};
  }
  north = cross(outward, east);
}

}  // namespace dmise
