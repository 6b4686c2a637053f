#pragma once
#include <cstddef>
#include <span>

#include "sensors/pipeline/view.h"

namespace dmise {

/// Adds to `times` what each correction of star places (proper motion ... refraction) costs a frame
/// in which `evaluations` places are computed: the corrections of one place run interleaved, so
/// each is measured on a sample of the frame's stars, with it and without it, and scaled. Returns
/// their sum.
double add_place_costs(const View& view, const StarColumns& columns,
                       std::span<const std::uint32_t> stars, std::size_t evaluations,
                       EffectTimes& times);

/// The same for space objects: light time, aberration by the sensor's motion, refraction.
double add_object_place_costs(const View& view, std::span<const std::size_t> objects,
                              std::size_t evaluations, EffectTimes& times);

}  // namespace dmise
