#pragma once
#include <memory>
#include <span>
#include <vector>

#include "core/base/numeric/simd_level.h"
#include "core/effects/effects.h"
#include "core/facets/facet_set.h"
#include "core/facets/facet_shadow.h"
#include "core/materials/panel.h"

namespace dmise {

/// Parallel light on an object, as a fraction of the Sun's irradiance there.
struct LightSource {
  Vec<Body> to_source{0, 0, 1};  // unit
  double share = 1.0;
};

/// What surfaces radiate by their temperature.
struct ThermalEmission {
  static constexpr EffectFacts facts{"thermal_emission",
                                     "objects with a shape radiate by their warmth",
                                     "at 300 K 1e-3 of the sunlight that a reflectance of 0.3 "
                                     "returns at 2.5 um, 7 times it at 5 um",
                                     "Planck's law and Kirchhoff's"};
  static bool applies(const SceneFacts& scene) { return scene.shapes; }
};

/// Light of an unresolved object: the sum over its facets in one band, each with the part of it
/// that no other facet hides from source or viewer. Facets are flat and light is parallel, so the
/// sum is exact up to rounding (1e-9). Interreflection is neglected.
class FacetLight {
 public:
  /// Without `emits` the object has no thermal emission.
  FacetLight(Mesh mesh, const Band& band, bool emits = true);

  /// This object with its panel turned to the Sun (panel.h). Costs a copy, no band means.
  FacetLight turned(const HingedPanel& panel, const Vec<Body>& to_sun) const;

  const Mesh& mesh() const { return mesh_; }
  const FacetSet& facets() const { return set_; }
  bool convex() const { return convex_; }

  /// Radiant intensity towards the viewer per unit irradiance [m2/sr]: multiplied by the Sun's
  /// photons/s/m2 at the object it gives photons/s/sr, divided by the distance squared
  /// photons/s/m2. Directions are unit vectors.
  double reflected_m2_per_sr(const Vec<Body>& to_sun, const Vec<Body>& to_viewer,
                             SimdLevel level = best_simd_level()) const;
  /// Light reflected of several sources.
  double reflected_m2_per_sr(std::span<const LightSource> sources, const Vec<Body>& to_viewer,
                             SimdLevel level = best_simd_level()) const;

  /// Thermal emission [photons/s/sr].
  double emitted_photons_per_s_sr(const Vec<Body>& to_viewer) const;

 private:
  /// Area of each facet that is visible from both; empty if nothing is hidden.
  std::vector<double> free_area_m2(const FacetShadow* sun, const FacetShadow& viewer) const;

  Mesh mesh_;
  FacetSet set_;
  bool convex_ = false;
};

}  // namespace dmise
