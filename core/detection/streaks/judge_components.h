#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "core/detection/pixels/components.h"
#include "core/detection/source/scene.h"

namespace dmise {

/// What the components of a frame are.
struct Judged {
  std::vector<Source> sources;
  std::uint32_t star_like = 0;  // components classified as stars
  // How far each component's light reaches that is not to be searched again [px]; empty where it
  // is, because it is neither a star nor a source.
  std::vector<std::optional<int>> reach_px;
  std::vector<bool> gave_source;  // one for each component
};

/// Compact components are classified independently, in parallel; long ones by falling size, so that
/// a streak's largest piece finds the whole of it and the others are recognised as pieces.
Judged judge_components(const Scene& scene, const FilteredFrame& filtered,
                        const std::vector<Component>& components, Threads& threads);

}  // namespace dmise
