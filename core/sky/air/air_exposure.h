#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string_view>

#include "core/effects/effects.h"
#include "core/photometry/band.h"
#include "core/sky/air/air_gases.h"
#include "core/sky/air/airmass.h"
#include "core/sky/air/clouds.h"
#include "core/sky/air/turbulence.h"

namespace dmise {

/// What effects of the air know of an exposure of a ground sensor.
struct AirExposure {
  const Band& band;
  const Curve& extinction_mag_per_airmass;  // over wavelength
  std::optional<AirGases> gases;            // none: only what the curve includes
  const std::optional<Clouds>& clouds;
  std::optional<BlownTurbulence> turbulence;  // none: scintillation ignores motion
  double aperture_m, exposure_s, site_height_m;
  double time_s;  // mid exposure, since the start of the run
  Vec<Gcrs> up;   // unit, at mid exposure
  Rotation<Enu, Gcrs> enu_from_gcrs;
  std::uint64_t seed;
  std::string_view sensor;  // its name
  std::uint32_t frame;
};

/// A source as a ground sensor sees it.
struct SightLine {
  enum class Source { star, object };

  Vec<Gcrs> apparent;  // unit
  double bv;           // colour: B - V [mag]
  Source source;
  std::uint32_t number;         // in its catalogue
  double rate_rad_per_s = 0.0;  // against the air
  /// At its elevation, if it is known already.
  std::optional<double> known_airmass = std::nullopt;
  double distance_m = std::numeric_limits<double>::infinity();
};

/// Stars as a ground sensor sees them, with their airmasses. All spans have one size.
struct SightLines {
  std::span<const Vec<Gcrs>> apparent;  // unit
  std::span<const double> airmass, bv, rate_rad_per_s;
  std::span<const std::uint32_t> number;  // in their catalogue

  std::size_t size() const { return apparent.size(); }
  SightLine operator[](std::size_t i) const {
    return {apparent[i], bv[i], SightLine::Source::star, number[i], rate_rad_per_s[i], airmass[i]};
  }
};

inline constexpr double sun_bv = 0.65;  // colour of the Sun [mag]

/// Elevation of a direction (unit) over the horizon whose zenith is `up` (unit) [rad].
inline double elevation_over(const Vec<Gcrs>& up, const Vec<Gcrs>& direction) {
  return std::asin(std::clamp(dot(up, direction), -1.0, 1.0));
}

/// Airmass of a source over the horizon whose zenith is `up` (unit).
inline double airmass_along(const Vec<Gcrs>& up, const SightLine& line) {
  return line.known_airmass ? *line.known_airmass : airmass(elevation_over(up, line.apparent));
}

}  // namespace dmise
