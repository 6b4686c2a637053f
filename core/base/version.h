#pragma once
#include <string>

namespace dmise {

/// "DMISE 1.0.0"
inline std::string software_name() { return "DMISE " DMISE_VERSION; }

}  // namespace dmise
