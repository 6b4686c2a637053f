#pragma once
#include <optional>
#include <span>

#include "core/detection/end_errors.h"
#include "core/detection/scene.h"

// Streaks that are faint for each pixel, whose ends are steps in noise: light beyond a gap of noise
// may be their own or not, and a fit stays at one of these.
namespace dmise {

/// The fit of such a streak with other ends, on its line or one turned a little, if these make the
/// light there likelier and are not those of one of `others` that is as long as half of it;
/// otherwise the source as it is.
Source with_likelier_ends(const Scene& scene, Source source, std::span<const Source> others);

/// Errors by all places of both ends of such a streak, on its line and on lines turned a little, by
/// how likely the light there makes each, with the flux and slope that it then has. Empty for
/// brighter ones and points.
std::optional<EndErrors> errors_of_faint_ends(const Scene& scene, const Source& source);

}  // namespace dmise
