#pragma once
#include "core/sky/air/air_extinction.h"
#include "core/sky/air/cloud_cover.h"
#include "core/sky/air/gas_absorption.h"
#include "core/sky/air/scintillation.h"

// An effect of the air dims the light of a source on its way to a ground sensor. It is a struct
// with
//   static constexpr EffectFacts facts;
//   static bool applies(const SceneFacts&);
//   a constructor from an AirExposure
//   double apply(const SightLine&) const;   the factor on the source's light
// and may have, where it is faster for many stars,
//   void apply(const SightLines&, std::span<double> factors) const;   multiplies the factors by it
// To add one: write its file pair, list it here, test it in tests/sky.
namespace dmise {

/// In the order in which they run.
using AirEffects = EffectList<AirExtinction, GasAbsorption, CloudCover, Scintillation>;

}  // namespace dmise
