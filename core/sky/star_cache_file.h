#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "core/sky/star_map.h"

namespace dmise {

/// What tells a catalogue's file from others: of its bytes as they lie there, and of its name,
/// because problems name it.
struct StarSource {
  std::uint32_t crc = 0;
  std::uint64_t bytes = 0;

  bool operator==(const StarSource&) const = default;
};

/// None for what can't be read or is no regular file.
std::optional<StarSource> star_source(const std::string& path);

/// Where the map of a source is kept.
std::string star_cache_path(const std::string& directory, const StarSource& source);

/// Puts a map's file into place, unless one of the same source lies there whole. Throws `Error`
/// "PATH: reason"; nothing is left of a file that could not be finished.
void write_star_cache(const std::string& path, const StarMap& map, const StarSource& source);

/// The map of a file that is mapped and not copied: all processes of a host share it. None unless
/// the file is whole, of this version, made of this source, and its values and index are such that
/// no use of them leads astray.
std::optional<StarMap> map_star_cache(const std::string& path, const StarSource& source);

}  // namespace dmise
