#pragma once
#include <optional>
#include <string>

#include "core/sky/stars/star_map_file.h"

namespace dmise {

/// Checksum and size of a file; none if it can't be read or is no regular file.
std::optional<StarSource> star_source(const std::string& path);

/// Where the map of a source is kept.
std::string star_cache_path(const std::string& directory, const StarSource& source);

/// Puts a map's file into place, unless one of the same source lies there whole. Throws `Error`
/// "PATH: reason"; nothing is left of a file that could not be finished.
void write_star_cache(const std::string& path, const StarMap& map, const StarSource& source);

/// The map of a kept file as `open_star_map` opens it. None unless the file is whole and made of
/// this source.
std::optional<StarMap> map_star_cache(const std::string& path, const StarSource& source);

}  // namespace dmise
