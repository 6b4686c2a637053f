#pragma once
#include "core/sky/places/aberration.h"
#include "core/sky/places/atmospheric_refraction.h"
#include "core/sky/places/light_deflection.h"
#include "core/sky/places/light_time.h"
#include "core/sky/places/parallax.h"
#include "core/sky/places/proper_motion.h"

// An effect of place is a step from the place of a star or satellite to the direction in which it
// is seen. It is a struct with
//   static constexpr EffectFacts facts;
//   static bool applies(const SceneFacts&);   unless it always does
//   a constructor from an Observer, where it has constants of one
// and one of
//   apply(const CataloguedStar&, Vec<Gcrs>& place) const   moves a star, and
//   apply(double epoch_jyear, CatalogueMotion&) const      many
//   Vec<Gcrs> apply(const Vec<Gcrs>& direction) const      turns starlight
//   velocity_c and displaces_satellites                    a velocity that aberrates
//   apply of LightTime and AtmosphericRefraction, which satellites have too
// To add one: write its file pair, list it here, test it in tests/sky.
namespace dmise {

/// In the order in which they run.
using PlaceEffects = EffectList<ProperMotion, Parallax, LightDeflection, AnnualAberration,
                                DiurnalAberration, LightTime, AtmosphericRefraction>;

}  // namespace dmise
