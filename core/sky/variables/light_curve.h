#pragma once
#include <cstdint>
#include <string_view>

namespace dmise {

/// How the light of a variable star goes on through a period.
enum class LightCurveShape : std::uint8_t {
  constant,
  separate_eclipses,  // two eclipses and the same light between them
  touching_eclipses,  // two eclipses of stars so near that their forms change the light throughout
  cepheid,            // classical Cepheids of the fundamental mode, and those of Population II
  rr_lyrae,           // RR Lyrae stars of the fundamental mode
  even,               // half a cosine down, half a cosine up: Miras, semi-regular stars, overtones
};

/// The shape of a type of variability of the General Catalogue of Variable Stars, such as "EA/SD"
/// or "DCEP(B)", and the share of the period that its light takes to rise (of EA: that an eclipse
/// lasts) where the catalogue has none: the median of the catalogue's stars of that type.
struct LightCurveKind {
  LightCurveShape shape = LightCurveShape::constant;
  double usual_share = 0.0;
};
LightCurveKind light_curve_kind(std::string_view type);

/// The light of one star over time.
struct StarLightCurve {
  LightCurveShape shape = LightCurveShape::constant;
  double brightest_v_mag = 0.0;
  double depth_mag = 0.0;         // from there to the faintest, >= 0; of eclipses: of the first
  double second_depth_mag = 0.0;  // depth in the second eclipse, half a period later
  double share = 0.0;             // part of the period: (0, 1) the rise, (0, 0.5] an eclipse
  double epoch_hjd = 0.0;         // heliocentric Julian date (UTC) of a maximum; of an eclipse
  double period_d = 1.0;          // > 0

  /// V at a heliocentric Julian date (UTC).
  double v_mag(double hjd) const { return brightest_v_mag + fainter_by_mag(phase(hjd)); }
  /// Periods since the epoch, without whole ones: [0, 1).
  double phase(double hjd) const;
  /// Magnitudes by which the star is fainter than at its brightest, at a phase in [0, 1).
  double fainter_by_mag(double phase) const;
  /// Its mean over a period, to 1e-4 of the depth.
  double mean_fainter_by_mag() const;
};

}  // namespace dmise
