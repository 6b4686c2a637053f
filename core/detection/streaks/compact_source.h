#pragma once
#include <vector>

#include "core/detection/pixels/components.h"
#include "core/detection/source/scene.h"

namespace dmise {

/// What a component is: a source, or two points that blend; or `star_like`, which is a star of this
/// frame, several, or what cannot be distinguished from them; or neither.
struct CompactJudgement {
  std::vector<Source> sources;
  bool star_like = false;
};

/// Judges a component no longer than a few PSFs: a star of this frame, blended stars, a point or
/// two among trailed stars, or a short streak. Neither where stars are known and no source is
/// fitted.
CompactJudgement judge_compact(const Scene& scene, const Component& component);

}  // namespace dmise
