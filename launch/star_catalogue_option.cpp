#include "launch/star_catalogue_option.h"

#include <filesystem>

#include "core/base/cache_directory.h"
#include "core/base/error.h"
#include "core/config/search_path.h"
#include "core/sky/star_cache.h"

namespace dmise {

CLI::Option* add_star_catalogue_option(CLI::App& command, std::string& name, bool may_be_none) {
  name = "kstars";
  return command
      .add_option("--catalogue", name,
                  may_be_none ? "star catalogue: kstars, a file, or none"
                              : "star catalogue: kstars, or a file")
      ->capture_default_str();
}

std::shared_ptr<const StarMap> load_star_catalogue(const std::string& name) {
  if (name == "none") return nullptr;
  const std::string path = name == "kstars" ? find_catalogue("stars.dat") : name;
  if (path.empty())
    throw ConfigError("--catalogue: stars.dat is not installed; ./dmise setup fetches it");
  const std::string cache = cache_directory();
  std::error_code ignored;  // without the directory nothing is kept, that is all
  if (!cache.empty()) std::filesystem::create_directories(cache, ignored);
  return std::make_shared<const StarMap>(load_star_map(path, cache));
}

}  // namespace dmise
