#pragma once
#include "core/detection/scene.h"

namespace dmise {

/// Whether a trail's light is even and complete enough for one object's path.
bool is_continuous(const Scene& scene, const Trail& trail);

/// Whether it is so uneven that a fit is not worth it, even if the trail is a rough first guess.
bool is_hopeless(const Scene& scene, const Trail& trail);

}  // namespace dmise
