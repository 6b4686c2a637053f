#pragma once
#include <variant>
#include <vector>

namespace dmise {

/// Cn2 [m^-2/3] by height, night model; the defaults are the 5/7 model (r0 = 5 cm, 7 urad at 0.5
/// um). Source: Hufnagel 1974; Valley 1980, Applied Optics 19, 574.
struct HufnagelValley {
  double high_wind_m_per_s = 21.0;  // rms wind at 5 to 20 km
  double ground_cn2 = 1.7e-14;      // at the ground [m^-2/3]

  bool operator==(const HufnagelValley&) const = default;
};

/// Cn2 measured at heights, log-linear between them and 0 outside.
struct Cn2Table {
  std::vector<double> height_m;  // above the site, ascending
  std::vector<double> cn2;       // [m^-2/3], > 0

  bool operator==(const Cn2Table&) const = default;
};

/// To add a profile: list it here, give it a `cn2` in turbulence.cpp, test it in
/// tests/sky/test_turbulence.cpp.
using TurbulenceProfile = std::variant<HufnagelValley, Cn2Table>;

/// Cn2 [m^-2/3] at a height above the site [m].
double cn2(const TurbulenceProfile& profile, double height_m);

/// Wind that carries the turbulence past the telescope.
struct TurbulenceWind {
  double ground_m_per_s = 5.0;
  double jet_m_per_s = 30.0;    // at 9.4 km; Bufton 1973, Applied Optics 12, 1785
  double slew_rad_per_s = 0.0;  // tracking: each layer seems to move by this times its distance

  bool operator==(const TurbulenceWind&) const = default;
};

/// Turbulence that is carried past the line of sight.
struct BlownTurbulence {
  TurbulenceProfile profile;
  TurbulenceWind wind;

  bool operator==(const BlownTurbulence&) const = default;
};

/// Speed of the layer at a height [m/s]; the wind and the slew are taken as at right angles.
double layer_speed_m_per_s(const TurbulenceWind& wind, double height_m, double airmass = 1.0);

/// What a profile does to an image.
struct Turbulence {
  double r0_m = 0.0;  // Fried's parameter
  double isoplanatic_angle_rad = 0.0;
  double wind_m_per_s = 0.0;  // speed of the turbulence, its mean by the power 5/3
  double tau0_s = 0.0;        // coherence time r0 / wind; Greenwood's is 0.314 of it
};

/// r0 = (0.423 k^2 X Int Cn2 dz)^(-3/5), theta0 = (2.914 k^2 X^(8/3) Int Cn2 z^(5/3) dz)^(-3/5), k
/// = 2 pi / wavelength, X the airmass (secant of the zenith angle). A profile without turbulence
/// gives infinite r0. Throws `Error` for a table that doesn't ascend or has values <= 0, wavelength
/// <= 0, airmass < 0.99. Source: Fried 1966, JOSA 56, 1372; Fried 1982, JOSA 72, 52; Greenwood
/// 1977, JOSA 67, 390.
Turbulence turbulence(const TurbulenceProfile& profile, double wavelength_m, double airmass = 1.0,
                      const TurbulenceWind& wind = {});

/// The mean of h^2 / speed over the turbulence, to which the variance of scintillation in a long
/// exposure is proportional [m s]; 0 for a profile without turbulence.
double scintillation_time_m_s(const BlownTurbulence& turbulence, double airmass = 1.0);

}  // namespace dmise
