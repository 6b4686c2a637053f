#pragma once
#include <vector>

#include "core/base/units.h"
#include "sensors/pipeline/object_sampler.h"
#include "sensors/pipeline/shape_layer.h"

namespace dmise {

/// Turning by less than this keeps the brightness of a shape, lobes included, to a percent or two.
inline constexpr double still_enough_rad = 0.25 * deg;

/// The arcs of an object with a shape that is drawn as a point: its path, then its light, so that a
/// glint shorter than an arc is not missed.
std::vector<Arc> shape_arcs(const View& view, const ObjectSampler& sampler, std::size_t object,
                            const std::vector<ObjectSample>& samples);

/// Snapshots of a resolved object: two for each pixel that it, or its outermost part, moves by.
std::vector<ShapeSnapshot> snapshots_of(const View& view, const ObjectSampler& sampler,
                                        std::size_t object,
                                        const std::vector<ObjectSample>& samples);

}  // namespace dmise
