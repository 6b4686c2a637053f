#pragma once
#include <vector>

#include "core/detection/source/scene.h"

namespace dmise {

/// Joins streaks that are flashes of one body: three or more behind each other on one line, as long
/// and as bright as each other and evenly spaced, of which the exposure has cut the first or the
/// last: in a train of objects all are equally long. The ends of a joined streak are those of the
/// light. Where the light does not show that an end is the exposure's, its error includes the dark
/// beside it. Rows along the trails of stars are left as they are.
std::vector<Source> with_joined_flashes(const Scene& scene, std::vector<Source> sources);

}  // namespace dmise
