#include "launch/star_catalogue_option.h"

#include "core/base/error.h"
#include "core/base/user_directories.h"
#include "core/config/search_path.h"
#include "core/config/star_catalogues.h"
#include "core/sky/star_cache.h"

namespace dmise {

CLI::Option* add_star_catalogue_option(CLI::App& command, std::string& name, bool may_be_none) {
  return command.add_option("--catalogue", name,
                            std::string("star catalogue: kstars, tycho2, ") +
                                (may_be_none ? "a file, or none" : "or a file") +
                                "; by default kstars");
}

std::shared_ptr<const StarMap> load_star_catalogue(const std::string& name) {
  if (name == "none") return nullptr;
  const std::string named = name.empty() ? default_star_catalogue : name;
  const char* file = star_catalogue_file(named);
  const std::string path = file ? find_catalogue(file) : named;
  if (path.empty()) throw ConfigError("--catalogue: " + missing_star_catalogue(named));
  return std::make_shared<const StarMap>(load_star_map(path, cache_directory()));
}

}  // namespace dmise
