#pragma once
#include <memory>
#include <string>

#include "core/sky/stars/star_map.h"

namespace dmise {

/// Loads a map as `load_star_map` does, or returns the one that this process has of the same file,
/// if that has not changed. The two maps used last are kept, and any that is still in use. Any
/// threads may call it.
std::shared_ptr<const StarMap> share_star_map(const std::string& path,
                                              const std::string& cache_dir);

}  // namespace dmise
