#pragma once
#include <string>

#include "core/sky/stars/star_map.h"

namespace dmise {

/// Opens the index at `path` (`open_star_map`), or reads the catalogue there (see `parse_stars`)
/// and indexes it. The result is kept in `cache_dir` (made if missing; none when empty) under the
/// digest and size of the source, written whole or not at all, and mapped from there: a host's
/// processes share one copy of the stars and of their index, and nothing is parsed or sorted again.
/// A cache that is damaged or of another version is passed over and written anew. A cache that
/// can't be written is no error: the map is then this process's own. Throws `ConfigError` as
/// `read_text_file`, `parse_stars` and `open_star_map` do.
StarMap load_star_map(const std::string& path, const std::string& cache_dir = "");

}  // namespace dmise
