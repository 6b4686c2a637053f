#pragma once
#include <memory>
#include <vector>

#include "core/base/numeric/rng.h"
#include "core/effects/effects.h"
#include "core/sky/air/air_exposure.h"

namespace dmise {

/// Relative standard deviation of a point source's light through one aperture: sigma^2 = 10e-6
/// D^(-4/3) / t X^3 exp(-2 h / 8000 m), D in metres, t in seconds. Exposures shorter than the
/// shadow pattern takes to cross the aperture (D / 20 m/s) average nothing: they count as that
/// long. Typical nights scatter by a factor 1.5 around it. Throws `Error` for an aperture <= 0 or
/// an exposure < 0. Source: Young 1967, AJ 72, 747; Osborn et al. 2015, MNRAS 452, 1707,
/// equation 7.
double scintillation_sigma(double aperture_m, double exposure_s, double airmass,
                           double site_height_m);

/// How motion averages scintillation in a long exposure: the variance of a source that moves over
/// that of one that stands still, (0, 1]. A layer's part goes as Cn2 h^2 over its speed past the
/// line of sight, which is the wind and, at right angles to it, the rate times its distance.
/// Source: Kenyon et al. 2006, PASP 118, 924; Dravins et al. 1998, PASP 110, 610.
class MotionAveraging {
 public:
  explicit MotionAveraging(const BlownTurbulence& turbulence);
  /// `rate_rad_per_s` against the air, >= 0.
  double operator()(double rate_rad_per_s, double airmass) const;

 private:
  std::vector<double> log_ratio_;  // by the logarithm of rate x airmass
};

/// Whether `Scintillation` takes the motion of sources into account.
struct MovingScintillation {
  static constexpr EffectFacts facts{
      "moving_scintillation",
      "scintillation averages by the source's own motion (off unless asked for)",
      "sources that move by 0.3 deg a second scintillate 2 times too much",
      "Kenyon et al. 2006, PASP 118, 924; Dravins et al. 1998, PASP 110, 610", false};
  static bool applies(const SceneFacts& scene) { return scene.on_ground; }
  static ErrorBound error(int, const PlanFacts& f);
  static double cost_s(int level, const PlanFacts& f);
};

/// Turbulence makes the light of point sources scintillate: in each frame a factor of mean 1,
/// log-normal with Young's deviation (held at 1), its own for every star and object.
class Scintillation {
 public:
  static constexpr EffectFacts facts{
      "scintillation", "turbulence makes point sources scintillate (Young)",
      "4 % for 0.3 m and 0.1 s at an airmass of 1.5", "Young 1967, AJ 72, 747"};
  static bool applies(const SceneFacts& scene) { return scene.on_ground; }

  /// Four deviations: one source in 16,000 is beyond.
  static ErrorBound error(int, const PlanFacts& f);
  static double cost_s(int level, const PlanFacts& f);

  explicit Scintillation(const AirExposure& exposure);
  double apply(const SightLine& line) const;
  void apply(const SightLines& lines, std::span<double> factors) const;

 private:
  /// At an airmass, of a source that moves by a rate.
  double sigma(double airmass, double rate_rad_per_s) const;

  RngKey key_;
  Vec<Gcrs> up_;
  double sigma_at_zenith_;
  double exposure_s_, shortest_s_;
  std::shared_ptr<const MotionAveraging> averaging_;  // null: motion is left out
};

}  // namespace dmise
