#pragma once
#include "core/facets/facet_set.h"

namespace dmise {

/// Puts the pictures of the mesh's materials into the set: means over facets for colours, normals
/// that stand for a facet's for height maps. Means are over quasi-random points, to 0.3 % of the
/// picture's range for a facet of its own.
void add_textures(const Mesh& mesh, const Band& band, FacetSet& set);

}  // namespace dmise
