#pragma once
#include <vector>

// The air over a site in spherical shells, for straight lines through all of it.
namespace dmise {

/// Amounts along a line: of molecules and of haze in vertical columns from the ground up, of ozone
/// in atm-cm. As a density, for each metre.
struct AirAmounts {
  double molecules = 0.0, haze = 0.0, ozone = 0.0;

  void add(double length_m, const AirAmounts& density) {
    molecules += length_m * density.molecules;
    haze += length_m * density.haze;
    ozone += length_m * density.ozone;
  }
};

/// Molecules of the standard air, haze that falls with height by `haze_scale_height_m`, and ozone.
class AirShells {
 public:
  static constexpr double top_m = 80e3;  // over the ground

  /// `ground_m`: over the sea.
  explicit AirShells(double ground_m);

  std::size_t levels() const { return radius_m_.size(); }
  double radius_m(std::size_t level) const { return radius_m_[level]; }
  /// Densities at a level, and their means in the shell over it.
  const AirAmounts& at_level(std::size_t level) const { return at_level_[level]; }
  const AirAmounts& in_shell(std::size_t level) const { return in_shell_[level]; }

  /// From a place to beyond the air. `sin_altitude` of the direction over the place's horizon; a
  /// line that meets the ground goes on from there upwards.
  AirAmounts towards(double radius_m, double sin_altitude) const;

  /// Share of the Sun's disc over the horizon of a place [0, 1].
  double sunlit_share(double radius_m, double sin_sun_altitude) const;

 private:
  std::vector<double> radius_m_;
  std::vector<AirAmounts> at_level_, in_shell_;
};

/// A line of sight from the ground in pieces, one in each shell.
struct LineThroughShells {
  struct Piece {
    double length_m, middle_m;  // along the line, from the observer
    double radius_m;            // at its middle
    AirAmounts before;          // between the observer and its middle
  };
  /// `sin_altitude` >= 0.
  LineThroughShells(const AirShells& shells, double sin_altitude);

  double sin_altitude;
  std::vector<Piece> pieces;
};

}  // namespace dmise
