#pragma once
#include "core/facets/facet_set.h"

namespace dmise {

/// Applies the pictures of the mesh's materials to the set: mean colours over facets, and
/// representative normals for height maps. Means over quasi-random points, to 0.3 % of the
/// picture's range on a facet of its own.
void add_textures(const Mesh& mesh, const Band& band, FacetSet& set);

}  // namespace dmise
