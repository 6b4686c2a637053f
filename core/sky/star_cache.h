#pragma once
#include <string>

#include "core/sky/star_file.h"
#include "core/sky/star_index.h"

namespace dmise {

/// A catalogue as the renderer uses it: in the index's order, with its index.
struct StarMap {
  StarCatalogue stars;
  StarIndex index;
  std::vector<std::string> problems;  // `file:line: reason` of what could not be used
  bool from_cache = false;
  std::string cache_problem;  // why nothing was kept for the next time; empty when all is well
};

/// Reads the catalogue at `path` (see `parse_stars`) and indexes it. The result of parsing is kept
/// in `cache_dir` (none when empty) under the digest and size of the source, written whole or not
/// at all; a cache that is damaged or of another version is passed over and written anew. A cache
/// that can't be written is no error. Throws `ConfigError` as `read_text_file` and `parse_stars`
/// do.
StarMap load_star_map(const std::string& path, const std::string& cache_dir = "");

}  // namespace dmise
