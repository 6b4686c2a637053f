#pragma once
#include <vector>

#include "core/photometry/band.h"

namespace dmise {

/// Air, in vertical columns from the sea, and ozone [atm-cm] along a line.
struct AirColumn {
  double air = 0.0, ozone = 0.0;
};

/// Columns of the standard air over a sphere along straight lines to beyond the air, by tables
/// within 0.5 % of the integrals. Heights in 0..`top_m`.
class AirColumns {
 public:
  static constexpr double top_m = 130e3, earth_radius_m = 6371e3;

  /// The shared instance.
  static const AirColumns& standard();

  /// Length of a vertical column if it had the density at the sea [m].
  double column_m() const { return column_m_; }
  /// A height within the tables, for use with many angles.
  struct Level {
    double height_m;
    std::size_t node;
    double part;
    AirColumn up;
  };
  Level level(double height_m) const;
  /// Upwards, `cos_zenith` in 0..1.
  AirColumn upwards(const Level& level, double cos_zenith) const;
  /// Air of a line downwards, `cos_zenith` in -1..0: past the lowest place of the line, which is at
  /// `lowest_m` >= 0.
  AirColumn downwards(const Level& level, double cos_zenith, double lowest_m) const;

 private:
  AirColumns();
  double column_m_ = 0.0;
  std::vector<AirColumn> log_up_, stretched_;  // by height, and by height and zenith angle
};

/// Sunlight in a band that air scatters once, dimmed by columns of air on its way.
class ScatteredSunlight {
 public:
  explicit ScatteredSunlight(const Band& band);
  /// Photons/s/m2/sr at 1 au over the phase function, for each metre of air at the density at the
  /// sea; 0 where columns let nothing through. `column`: all air on the way before and after
  /// scattering.
  double behind(const AirColumn& column) const;

 private:
  std::vector<double> log_light_;  // by air and ozone
};

}  // namespace dmise
