#pragma once
#include <span>

#include "core/effects/plan_facts.h"
#include "core/frames/oblate_earth.h"

namespace dmise {

/// The shadow of the oblate Earth at one instant: umbra, penumbra and, beyond 1.38e6 km, the ring.
/// The Sun is a uniform disc of 695,700 km radius (IAU 2015 Resolution B3), the Earth has no air:
/// refracted and absorbed light at the shadow's edge is left out.
class EarthShadow {
 public:
  static constexpr EffectFacts facts{
      "shadow", "objects are dimmed by the Earth's penumbra and umbra",
      "objects in shadow are drawn fully lit", "two discs: the Sun's and the Earth's"};

  static ErrorBound error(int, const PlanFacts& f) {
    return f.near_shadow ? not_bounded : ErrorBound{};
  }
  static double cost_s(int level, const PlanFacts& f) { return level * 2e-6 * double(f.objects); }

  /// `sun_m`: geocentric position of the Sun.
  EarthShadow(const Vec<Gcrs>& sun_m, const OblateEarth& earth);

  /// Fraction of the solar disc that an object at `object_m` sees past the Earth, 0..1: continuous,
  /// monotone through the penumbra. Throws `Error` for a place inside the Earth.
  double sunlit_fraction(const Vec<Gcrs>& object_m) const;

  /// The same for a whole catalogue: `position_m` is all x, all y, all z of `fraction.size()`
  /// objects. Those inside the Earth (and those without a state, whose position is 0) get 0.
  /// Returns how many.
  std::size_t sunlit_fractions(std::span<const double> position_m,
                               std::span<double> fraction) const;

 private:
  double in_penumbra(const Vec<Gcrs>& object_m, const Vec<Gcrs>& stretched_m) const;
  bool fully_lit(double along_m, double across_squared_m2) const;
  bool fully_dark(double along_m, double across_squared_m2) const;

  Vec<Gcrs> sun_m_;
  Vec<Gcrs> towards_sun_;
  OblateEarth earth_;
};

/// One object; see `EarthShadow`.
double sunlit_fraction(const Vec<Gcrs>& object_m, const Vec<Gcrs>& sun_m, const OblateEarth& earth);

}  // namespace dmise
