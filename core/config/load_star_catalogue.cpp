#include "core/config/load_star_catalogue.h"

#include "core/base/error.h"
#include "core/base/files/user_directories.h"
#include "core/config/star_catalogues.h"
#include "core/config/yaml/search_path.h"
#include "core/sky/stars/shared_star_map.h"

namespace dmise {

std::shared_ptr<const StarMap> load_star_catalogue(const std::string& name,
                                                   const std::string& option) {
  if (name == "none") return nullptr;
  const std::string named = name.empty() ? default_star_catalogue : name;
  const char* file = star_catalogue_file(named);
  const std::string path = file ? find_catalogue(file) : named;
  if (path.empty()) throw ConfigError(option + ": " + missing_star_catalogue(named));
  return share_star_map(path, cache_directory());
}

}  // namespace dmise
