#include "core/sky/stars/star_cache.h"

#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/base/files/paths.h"
#include "core/base/files/text_file.h"
#include "core/sky/stars/star_cache_file.h"
#include "core/sky/stars/star_file.h"

namespace dmise {
namespace {

StarMap read_star_map(const std::string& path) {
  StarReading reading = parse_stars(read_text_file(path), path);
  return star_map_of(std::move(reading.catalogue), std::move(reading.problems));
}

}  // namespace

StarMap load_star_map(const std::string& path, const std::string& cache_dir) {
  if (is_star_map_file(path)) return std::move(open_star_map(path).map);
  const auto source = cache_dir.empty() ? std::nullopt : star_source(path);
  if (!source) return read_star_map(path);
  const std::string cache_path = star_cache_path(cache_dir, *source);
  if (auto kept = map_star_cache(cache_path, *source)) return std::move(*kept);
  StarMap map = read_star_map(path);
  if (star_source(path) != source) return map;  // changed meanwhile: may be of either version
  try {
    make_directories(cache_dir);
    write_star_cache(cache_path, map, *source);
  } catch (const Error& error) {
    map.cache_problem = error.what();
    return map;
  }
  // Maps the file, as other processes do, and drops this process's own copy.
  auto shared = map_star_cache(cache_path, *source);
  if (!shared) return map;
  shared->from_cache = false;
  return std::move(*shared);
}

}  // namespace dmise
