#pragma once
#include <optional>
#include <span>

#include "core/detection/source/end_errors.h"
#include "core/detection/source/scene.h"

// Ends of streaks that are faint in each pixel. Such an end is a step lost in noise: light behind a
// gap may belong to the streak or not, and a fit finds only one of the possible ends.
namespace dmise {

/// Returns the fit of such a streak with other ends, on its line or on one turned a little, if they
/// explain the light better and it does not then cover one of `others` that is at least half as
/// long; otherwise the source as it is.
Source with_likelier_ends(const Scene& scene, Source source, std::span<const Source> others);

/// Returns the errors of such a streak by its ends: the mean over all places of both, on its line
/// and on lines turned a little, weighted by their likelihood, each with its own flux and slope.
/// Empty for brighter streaks and points.
std::optional<EndErrors> errors_of_faint_ends(const Scene& scene, const Source& source);

}  // namespace dmise
