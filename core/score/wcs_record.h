#pragma once
#include "core/score/json_record.h"
#include "core/wcs/wcs.h"

namespace dmise {

/// The world coordinate system of a frame's report, from its object `wcs` in frames.jsonl. Throws
/// `ConfigError` "FILE:LINE: KEY: reason".
Wcs wcs_of(const JsonRecord& wcs);

}  // namespace dmise
