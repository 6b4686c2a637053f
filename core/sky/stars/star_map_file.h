#pragma once
#include <cstdint>
#include <string>

#include "core/sky/stars/star_map.h"

namespace dmise {

/// Identifies a catalogue's file: checksum of its bytes and of its path, which problems contain,
/// and its size.
struct StarSource {
  std::uint32_t crc = 0;
  std::uint64_t bytes = 0;

  bool operator==(const StarSource&) const = default;
};

/// Increase it whenever a reader, the index or the layout of the file changes.
inline constexpr std::uint32_t star_map_version = 4;

/// Whether a regular file begins like a map's; false where there is none.
bool is_star_map_file(const std::string& path);

/// Writes a map and what it was made of as PATH, whole or not at all. Throws `Error`
/// "PATH: reason".
void write_star_map(const std::string& path, const StarMap& map, const StarSource& source);

/// A map's file that is mapped and not copied: all processes of a host share it.
struct OpenedStarMap {
  StarMap map;
  StarSource source;
};

/// Opens a map's file: checks its header, its index and the tables that check the stars; the stars
/// themselves at once where they are few, else when `query_cone` comes to them. Throws
/// `ConfigError` "PATH: reason" for a file that is cut short, of another version, or wrong.
OpenedStarMap open_star_map(const std::string& path);

/// The bytes of a map's file before its columns, with the checksums of all columns: they identify
/// the file and are small. Throws `ConfigError` as `open_star_map` does.
std::string star_map_fingerprint(const std::string& path);

}  // namespace dmise
