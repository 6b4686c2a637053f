#pragma once
#include <array>
#include <span>

#include "core/effects/effects.h"
#include "core/frames/oblate_earth.h"
#include "core/sky/air/grazing_air.h"

namespace dmise {

/// The shadow of the oblate Earth at one instant: umbra, penumbra and, beyond 1.38e6 km, antumbra.
/// The Sun has a radius of 695,700 km (IAU 2015 Resolution B3).
class EarthShadow {
 public:
  /// How the edge is computed. sharp: a uniform Sun, and an Earth without air; limb: the Sun
  /// darkens towards its limb; air: the air dims and refracts grazing light, too.
  enum class Edge { sharp = 1, limb, air };
  static constexpr std::array<std::string_view, 4> levels{"off", "sharp", "limb", "air"};
  static constexpr EffectFacts facts{
      "shadow",
      "objects are dimmed by the Earth's penumbra and umbra",
      "objects in shadow are drawn fully lit; sharp: 3 mag too bright at its edge in a low orbit, "
      "0.5 in a geosynchronous one",
      "two discs; limb darkening by Hestroffer & Magnan 1998, A&A 333, 338; rays through the "
      "standard atmosphere",
      true,
      true,
      levels,
      1};

  static ErrorBound error(int level, const PlanFacts& f);
  static double cost_s(int level, const PlanFacts& f);

  /// `sun_m`: geocentric position of the Sun.
  EarthShadow(const Vec<Gcrs>& sun_m, const OblateEarth& earth);
  /// In a band; `sharp` is the same in all.
  EarthShadow(const Vec<Gcrs>& sun_m, const OblateEarth& earth, Edge edge, const Band& band);

  /// Fraction of the Sun's light that reaches an object at `object_m` past the Earth, 0..1:
  /// continuous, monotone through the penumbra. Throws `Error` for a place inside the Earth.
  double sunlit_fraction(const Vec<Gcrs>& object_m) const;

  /// Fractions of the objects of a catalogue: `position_m` is all x, all y, all z of
  /// `fraction.size()` objects. Those inside the Earth (and those without a state, whose position
  /// is 0) get 0. Returns how many.
  std::size_t sunlit_fractions(std::span<const double> position_m,
                               std::span<double> fraction) const;

 private:
  double light_of(const LowSun& sun, double distance_m, double radius_m) const;
  double in_penumbra(const Vec<Gcrs>& object_m, const Vec<Gcrs>& stretched_m) const;
  bool fully_lit(double along_m, double across_squared_m2) const;
  bool fully_dark(double along_m, double across_squared_m2) const;

  // Slope of the edges of penumbra and umbra: tan of the Sun's radius.
  static constexpr double cone_slope = 0.0048;

  Edge edge_ = Edge::sharp;
  Band band_;  // that sunlight is seen in; the sharp edge needs none
  double dark_slope_ = cone_slope;
  Vec<Gcrs> sun_m_;
  Vec<Gcrs> towards_sun_;
  OblateEarth earth_;
};

}  // namespace dmise
