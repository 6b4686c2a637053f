#pragma once
#include <cstdint>
#include <vector>

#include "core/sky/places/apparent.h"
#include "core/sky/stars/star_map.h"

namespace dmise {

/// A star of the catalogue as it is seen at one instant.
struct SeenStar {
  std::uint32_t index = 0;  // in the catalogue
  Vec<Gcrs> direction;      // apparent, unit
  float v_mag = 0.0F, bv = 0.0F;
};

/// The catalogue's stars as an observer sees them: proper motion, parallax, light deflection,
/// aberration and, if the observer has air, refraction.
class PlateSky {
 public:
  PlateSky(const StarMap& map, const Observer& observer);

  const StarMap& map() const { return map_; }
  const std::optional<Air>& air() const { return air_; }
  const ApparentPlaces& places() const { return places_; }
  Vec<Gcrs> direction(std::uint32_t star) const;
  /// Number of stars not fainter than a magnitude; the magnitude that as many stars reach. Large
  /// catalogues tell them to a tenth of a magnitude.
  std::size_t brighter_than(float v_mag) const;
  float magnitude_of_rank(double rank) const;
  /// Numbers of the stars within `radius_rad` of an axis in the catalogue, among the brightest
  /// `rank` of the whole sky.
  std::vector<std::uint32_t> catalogued(const Vec<Gcrs>& axis, double radius_rad,
                                        double rank) const;
  /// The brightest `most` stars within `radius_rad` of an apparent axis and above the horizon, by
  /// rising magnitude.
  std::vector<SeenStar> brightest(const Vec<Gcrs>& axis, double radius_rad, std::size_t most) const;

 private:
  const StarMap& map_;
  std::optional<Air> air_;
  ApparentPlaces places_;
  std::vector<float> sorted_v_mag_;  // empty for large catalogues
};

}  // namespace dmise
