#pragma once
#include "core/detection/source/scene.h"

namespace dmise {

/// Whether a trail's light is even and complete enough for one object's path.
bool is_continuous(const Scene& scene, const Trail& trail);

/// Whether it is so uneven that a fit is not worth it, even if the trail is a rough first guess.
bool is_hopeless(const Scene& scene, const Trail& trail);

/// Whether there is light all along a trail that is so bright that each few px show it, however it
/// changes: a fifth of the mean light is enough. Between stars in a row there is none.
bool is_lit_throughout(const Scene& scene, const Trail& trail);

}  // namespace dmise
