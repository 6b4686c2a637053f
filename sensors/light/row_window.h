#pragma once
#include <functional>
#include <optional>

#include "core/optics/blur/deposit.h"
#include "sensors/scene/view.h"

namespace dmise {

/// Row of a source at a time of the exposure; nothing where it has no place in the image.
using RowAt = std::function<std::optional<double>(SimTime)>;

/// Returns when a rolling shutter exposes a moving source: from the time at which its row opens to
/// the time at which the row where it then is closes. If the source is as fast as the shutter, the
/// longest such time, or 1 ns if its row is never open. Beyond the frame rows are as the nearest
/// one. Exact for points; a blur is taken to be exposed as its centre.
FrameTimes row_window(const View& view, const RowAt& row_at);

/// The part of a path that a rolling shutter exposes, with its light. `whole` has the light and
/// path from the opening of the first row to the end of the last.
Arc rolled(const View& view, const Arc& whole);

}  // namespace dmise
