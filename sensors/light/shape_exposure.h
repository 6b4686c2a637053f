#pragma once
#include <vector>

#include "core/base/units.h"
#include "sensors/light/shape_layer.h"
#include "sensors/objects/object_sampler.h"

namespace dmise {

/// Turning by less than this keeps the brightness of a shape, lobes included, to a percent or two.
inline constexpr double still_enough_rad = 0.25 * deg;

/// How many arcs follow the light of an object with a shape as it turns and glints: `arcs` times a
/// power of two, `most` at most, which is one too.
std::size_t arcs_for_light(const View& view, const ObjectSampler& sampler, std::size_t object,
                           std::size_t arcs, std::size_t most);

/// The arcs of an object with a shape that is drawn as a point: its path, then its light, so that a
/// glint shorter than an arc is not missed.
std::vector<Arc> shape_arcs(const View& view, const ObjectSampler& sampler, std::size_t object,
                            const std::vector<ObjectSample>& samples);

/// Poses in which a resolved object is drawn over the exposure: so many that its outermost part
/// jumps by half a pixel at most from one to the next, or `max_poses`.
int poses_of(const View& view, const ObjectSampler& sampler, std::size_t object);
inline constexpr int max_poses = 64;

/// A resolved object in `poses` poses, each swept along its part of the path. `samples` as for
/// `arcs_of`, of as many arcs as poses or more. The light is that of `shape_arcs`; each pose is
/// that of the brightest of some instants of its time, glints between them included.
std::vector<ShapeSnapshot> snapshots_of(const View& view, const ObjectSampler& sampler,
                                        std::size_t object,
                                        const std::vector<ObjectSample>& samples, int poses);

}  // namespace dmise
