#include "core/sky/bodies/limb_airglow.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/effects/plan_facts.h"
#include "core/photometry/magnitude.h"
#include "core/photometry/spectrum.h"
#include "core/sky/surface_brightness.h"

namespace dmise {
namespace {

// Baker & Stair 1988 find OH at 87 km, 8.6 km wide at half its peak. The green line of oxygen has
// its peak at 96 km, the continuum with it, sodium's at 90 km: 95 km for all of these. Here
// relative to the one layer of `Airglow`, 90 km.
constexpr double oh_above_layer_m = -3e3, rest_above_layer_m = 5e3;
constexpr double width_at_half_m = 8.6e3;
/// Half of the whole width of (1 - x^2)^2 over its width at half of the peak.
const double half_of_width = 0.5 / std::sqrt(1.0 - std::sqrt(0.5));
/// From here on OH alone shines, as `airglow_spectrum` has it.
constexpr double oh_from_m = 695 * nm;

/// The part of a spectrum on one side of `oh_from_m`, 0 wherever it is not known.
Spectrum part_of(const Spectrum& whole, bool oh) {
  const Curve& from = whole.irradiance;
  Curve part{{1 * nm, from.wavelength_m.front() * 0.9999}, {0.0, 0.0}};
  for (std::size_t i = 0; i < from.value.size(); ++i) {
    part.add(from.wavelength_m[i], (from.wavelength_m[i] > oh_from_m) == oh ? from.value[i] : 0.0);
  }
  part.add(from.wavelength_m.back() * 1.0001, 0.0);
  part.add(1.0, 0.0);
  return {part};
}

/// Gauss's five places and weights, exact to degree 9; that of a shell's light along a line is 8.
constexpr std::array<std::array<double, 2>, 5> gauss{{{-0.90617984593866399, 0.23692688505618909},
                                                      {-0.53846931010568309, 0.47862867049936647},
                                                      {0.0, 0.56888888888888889},
                                                      {0.53846931010568309, 0.47862867049936647},
                                                      {0.90617984593866399, 0.23692688505618909}}};

/// A shell against a line, by squares of distances from the centre: q = (r^2 - radius^2) / (2
/// radius) is the height but for 0.7 %, and rises along a line as a parabola.
struct Crossing {
  const AirglowShells::Shell& shell;
  double radius_m, nearest_m;

  double middle_q() const { return q_of(shell.middle_m); }
  double half_width_q() const { return shell.half_width_m * (1.0 + shell.middle_m / radius_m); }
  double q_of(double height_m) const { return height_m * (1.0 + 0.5 * height_m / radius_m); }

  /// How far from the lowest place the line meets a surface of this q; 0: it stays above.
  double meets_m(double q) const {
    const double below_m2 = 2.0 * radius_m * q + (radius_m - nearest_m) * (radius_m + nearest_m);
    return std::sqrt(std::max(0.0, below_m2));
  }
  /// Integral of (1 - x^2)^2 between two places on the line.
  double between(double from_m, double to_m) const {
    if (!(to_m > from_m)) return 0.0;
    const double middle = 0.5 * (from_m + to_m), half = 0.5 * (to_m - from_m);
    const double nearest_q = 0.5 * (nearest_m - radius_m) * (nearest_m + radius_m) / radius_m;
    double sum = 0.0;
    for (const auto& [at, weight] : gauss) {
      const double s = middle + half * at;
      const double x = (nearest_q + 0.5 * s * s / radius_m - middle_q()) / half_width_q();
      const double y = std::max(0.0, 1.0 - x * x);
      sum += weight * y * y;
    }
    return sum * half;
  }
  double inner_m() const { return meets_m(middle_q() - half_width_q()); }
  double outer_m() const { return meets_m(middle_q() + half_width_q()); }
};

/// Metres of a line straight up, if all of it shone as the middle does; of any Earth to 2e-5.
double whole_m(const AirglowShells::Shell& shell) {
  const Crossing up{shell, wgs84.equatorial_radius_m, 0.0};
  return up.between(up.inner_m(), up.outer_m());
}

}  // namespace

ErrorBound LimbAirglow::error(int, const PlanFacts& f) {
  return f.without_light([&](const SkySample&) { return f.limb_airglow_e; });
}

double LimbAirglow::cost_s(int level, const PlanFacts& f) {
  return f.scene.limb_in_field ? level * 130e-9 * f.pixels() : 0.0;
}

AirglowShells::AirglowShells(const Airglow& airglow, const Band& band) {
  const double by_sun = airglow_by_solar_flux(airglow.solar_flux_sfu);
  const double s10 = by_sun * s10_of_mag_per_arcsec2(airglow.zenith_v_mag_per_arcsec2);
  const Spectrum spectrum = airglow_spectrum(by_sun);
  // The S10 are the whole spectrum's light in V, as `photons_per_s_m2_sr_of_s10` has it.
  const double in_v = photon_rate_per_m2(spectrum, johnson_v());
  const double photons = s10 * photons_per_s_m2_sr_of_s10(johnson_v(), spectrum) / in_v;
  const auto of = [&](bool oh) {
    return photons * photon_rate_per_m2(part_of(spectrum, oh), band);
  };
  const double half_width_m = half_of_width * width_at_half_m;
  shells_ = {Shell{airglow.layer_height_m + oh_above_layer_m, half_width_m, of(true)},
             Shell{airglow.layer_height_m + rest_above_layer_m, half_width_m, of(false)}};
  for (Shell& shell : shells_)
    shell.photons_per_s_m3_sr = shell.zenith_photons_per_s_m2_sr / whole_m(shell);
}

double AirglowShells::top_m() const {
  double top = 0.0;
  for (const Shell& shell : shells_) top = std::max(top, shell.middle_m + shell.half_width_m);
  return top + 1e3;
}

double AirglowShells::zenith_photons_per_s_m2_sr() const {
  double sum = 0.0;
  for (const Shell& shell : shells_) sum += shell.zenith_photons_per_s_m2_sr;
  return sum;
}

double AirglowShells::photons_per_s_m2_sr(const LimbLine& line, double behind) const {
  double light = 0.0;
  for (const Shell& shell : shells_) {
    if (!(shell.zenith_photons_per_s_m2_sr > 0.0)) continue;
    const Crossing crossing{shell, line.radius_m, line.nearest_m};
    const double inner_m = crossing.inner_m(), outer_m = crossing.outer_m();
    const double before =
        crossing.between(std::max(line.from_m, -outer_m), std::min(-inner_m, 0.0));
    const double beyond =
        line.meets_ground() ? 0.0 : crossing.between(std::max(line.from_m, inner_m), outer_m);
    light += shell.photons_per_s_m3_sr * (before + behind * beyond);
  }
  return light * line.true_scale;
}

}  // namespace dmise
