#pragma once
#include <optional>

#include "core/detection/scene.h"

namespace dmise {

/// How far a streak's middle and length may be from those of its fit: means of squares over all
/// places of both ends on its line, by how likely each is.
struct EndErrors {
  double middle_px2 = 0.0, length_px2 = 0.0;
};

/// Of a streak that is faint for each pixel, whose ends are steps in noise: light beyond a gap of
/// noise may be its own or not, and a fit stays at one of these. Empty for brighter ones and
/// points.
std::optional<EndErrors> errors_of_faint_ends(const Scene& scene, const Source& source);

}  // namespace dmise
