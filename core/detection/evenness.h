#pragma once
#include "core/detection/scene.h"

namespace dmise {

/// Even and complete enough to be one object's path.
bool is_continuous(const Scene& scene, const Trail& trail);

/// Not worth a fit: even an inaccurate first guess is not this uneven.
bool is_hopeless(const Scene& scene, const Trail& trail);

}  // namespace dmise
