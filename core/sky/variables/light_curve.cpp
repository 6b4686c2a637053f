#include "core/sky/variables/light_curve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "core/base/units.h"

namespace dmise {
namespace {

struct Harmonic {
  double amplitude_mag, phase_rad;  // amplitude cos(2 pi k x + phase)
};

/// A pulsation by its Fourier series, with the places and values of its extremes.
struct Pulsation {
  std::span<const Harmonic> series;
  double brightest_at, brightest, faintest_at, faintest;

  double rise() const {
    const double rise = brightest_at - faintest_at;
    return rise - std::floor(rise);
  }
  /// 0 at the brightest, 1 at the faintest; `x`: periods after the brightest.
  double at(double x) const {
    double sum = 0.0;
    for (std::size_t k = 0; k < series.size(); ++k)
      sum += series[k].amplitude_mag *
             std::cos(2.0 * pi * double(k + 1) * (x + brightest_at) + series[k].phase_rad);
    return (sum - brightest) / (faintest - brightest);
  }
};

// Delta Cephei in V: amplitudes, whole range and share of the rise by the AAVSO's observations
// (arXiv:2606.29543). The two phases are the ones by which the range and the rise follow from the
// amplitudes, near those of Cepheids of its period (Simon & Lee 1981, ApJ 248, 291).
constexpr std::array<Harmonic, 3> delta_cephei = {{{0.3434, 0.0}, {0.1428, 4.36}, {0.0531, 2.50}}};
constexpr Pulsation cepheid_curve{delta_cephei, 0.41603187, -0.46989331, 0.12748259, 0.38456037};

// RRab: 0.42 g + 0.58 r of the mean curves in Stringer et al. 2019 (AJ 158, 16), of 483 stars.
constexpr std::array<Harmonic, 8> fundamental = {{{0.3246, 2.478},
                                                  {0.1428, 2.598},
                                                  {0.0960, 3.003},
                                                  {0.0568, 3.505},
                                                  {0.0323, 3.991},
                                                  {0.0184, 4.523},
                                                  {0.0111, 5.039},
                                                  {0.0064, 5.332}}};
constexpr Pulsation rr_lyrae_curve{fundamental, 0.99781308, -0.54388486, 0.83800640, 0.30339827};

/// Depth of an eclipse relative to its middle, `x` half durations from it. Source: Andronov 2012,
/// Astrophysics 55, 536; the exponent 1.2 is that of eclipses that are not total.
double eclipse(double x) {
  return std::abs(x) < 1.0 ? std::pow(1.0 - std::pow(std::abs(x), 1.2), 1.5) : 0.0;
}

// Stars that touch: PHOEBE's contact and semi-detached binaries are met to 0.025 mag.
constexpr double half_of_touching = 0.11;  // half of an eclipse, in periods
constexpr double share_of_forms = 0.5;     // share of the shallower eclipse by the stars' forms

struct CurveOfType {
  std::string_view type;
  LightCurveKind kind;
};
using enum LightCurveShape;
// Shares: medians of the stars of each type with Hipparcos numbers. An eclipsing star of which no
// more is known (E) is taken for EA.
constexpr std::array<CurveOfType, 19> types = {{{"EA", {separate_eclipses, 0.10}},
                                                {"E", {separate_eclipses, 0.10}},
                                                {"EB", {touching_eclipses, 0.5}},
                                                {"EW", {touching_eclipses, 0.5}},
                                                {"DCEP", {cepheid, 0.30}},
                                                {"CEP", {cepheid, 0.32}},
                                                {"CW", {cepheid, 0.35}},
                                                {"CWA", {cepheid, 0.35}},
                                                {"CWB", {cepheid, 0.35}},
                                                {"DCEPS", {even, 0.45}},
                                                {"RR", {rr_lyrae, 0.16}},
                                                {"RRAB", {rr_lyrae, 0.16}},
                                                {"RRC", {even, 0.40}},
                                                {"M", {even, 0.46}},
                                                {"SR", {even, 0.50}},
                                                {"SRA", {even, 0.50}},
                                                {"SRB", {even, 0.49}},
                                                {"SRC", {even, 0.46}},
                                                {"SRD", {even, 0.46}}}};

/// A phase from the maximum, moved so that what rises in `rise` of a period rises in `share` of it.
double with_rise(double phase, double share, double rise) {
  if (phase <= 1.0 - share) return phase * (1.0 - rise) / (1.0 - share);
  return 1.0 - (1.0 - phase) * rise / share;
}

}  // namespace

LightCurveKind light_curve_kind(std::string_view type) {
  const std::string_view main = type.substr(0, type.find_first_of("/+(: "));
  for (const CurveOfType& curve : types)
    if (curve.type == main) return curve.kind;
  return {};
}

double StarLightCurve::phase(double hjd) const {
  const double periods = (hjd - epoch_hjd) / period_d;
  const double phase = periods - std::floor(periods);
  return phase < 1.0 ? phase : 0.0;  // 1 if rounded from just below 0
}

double StarLightCurve::fainter_by_mag(double phase) const {
  const double from_first = std::min(phase, 1.0 - phase), from_second = std::abs(phase - 0.5);
  switch (shape) {
    case LightCurveShape::constant:
      break;
    case LightCurveShape::separate_eclipses:
      return depth_mag * eclipse(2.0 * from_first / share) +
             second_depth_mag * eclipse(2.0 * from_second / share);
    case LightCurveShape::touching_eclipses: {
      const double forms = share_of_forms * std::min(depth_mag, second_depth_mag);
      return forms * 0.5 * (1.0 + std::cos(4.0 * pi * phase)) +
             (depth_mag - forms) * eclipse(from_first / half_of_touching) +
             (second_depth_mag - forms) * eclipse(from_second / half_of_touching);
    }
    case LightCurveShape::cepheid:
      return depth_mag * cepheid_curve.at(with_rise(phase, share, cepheid_curve.rise()));
    case LightCurveShape::rr_lyrae:
      return depth_mag * rr_lyrae_curve.at(with_rise(phase, share, rr_lyrae_curve.rise()));
    case LightCurveShape::even:
      return depth_mag * 0.5 * (1.0 - std::cos(2.0 * pi * with_rise(phase, share, 0.5)));
  }
  return 0.0;
}

double StarLightCurve::mean_fainter_by_mag() const {
  constexpr int steps = 1000;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) sum += fainter_by_mag((i + 0.5) / steps);
  return sum / steps;
}

}  // namespace dmise
