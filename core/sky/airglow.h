#pragma once
#include <optional>

#include "core/effects/effects.h"
#include "core/photometry/spectrum.h"

namespace dmise {

/// Light of the upper atmosphere at night: brightest towards the horizon, where the path through
/// its layer is longest.
struct Airglow {
  static constexpr EffectFacts facts{"airglow", "light of the upper atmosphere",
                                     "22.4 mag/arcsec2 at the zenith",
                                     "van Rhijn 1921, Publ. Astr. Lab. Groningen 31"};
  static bool applies(const SceneFacts& scene) { return scene.on_ground; }
  static ErrorBound error(int, const PlanFacts& f);
  static double cost_s(int level, const PlanFacts& f);

  double zenith_v_mag_per_arcsec2 = 22.4;  // at the ground; 21.9 to 22.6 over the solar cycle
  double layer_height_m = 90e3;
  /// The Sun's flux at 10.7 cm, monthly mean [sfu: 10^-22 W/m2/Hz]. If it is given,
  /// `zenith_v_mag_per_arcsec2` is the brightness at 130 sfu.
  std::optional<double> solar_flux_sfu;
};

/// Light of lines and continuum, without OH, at a solar flux S over that at 130 sfu: (0.2068 +
/// 0.006139 S) / 1.0049; 1 without a flux. Source: Noll et al. 2012, A&A 543, A92, for the
/// continuum.
double airglow_by_solar_flux(const std::optional<double>& solar_flux_sfu);

/// Path through a thin layer at `layer_height_m` relative to the zenith's; `sin_altitude` is held
/// at 0 below it. Source: van Rhijn 1921, Publ. Astr. Lab. Groningen 31.
double van_rhijn(double sin_altitude, double layer_height_m);

/// Brightness at the ground [S10 in V]; `diffuse_extinction_mag`: extinction towards the zenith of
/// the light of a layer over the whole sky, as Noll et al. give it.
double airglow_s10(const Airglow& airglow, double sin_altitude, double diffuse_extinction_mag);

/// Its colour, 0.2-2.25 um, and none to 100 um: lines of oxygen, sodium and OH over a continuum. To
/// 0.97 um the night sky of La Palma (Benn & Ellison 1998, ING technical note 115) every 10 nm,
/// beyond it by Y, J, H and K of ESO's sky calculator. `brighter`: light without OH over that at
/// 130 sfu; OH, from 0.7 um on, does not follow the Sun and is divided by it.
Spectrum airglow_spectrum(double brighter = 1.0);

}  // namespace dmise
