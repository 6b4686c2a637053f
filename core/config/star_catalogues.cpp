#include "core/config/star_catalogues.h"

#include "core/config/yaml/search_path.h"

namespace dmise {

const char* star_catalogue_file(const std::string& name) {
  if (name == "kstars") return "stars.dat.gz";
  if (name == "tycho2") return "tycho2.stars";
  return nullptr;
}

std::string missing_star_catalogue(const std::string& name) {
  return name == "tycho2" ? "Tycho-2 is missing; `dmise catalogue fetch tycho2` makes it"
                          : missing_catalogue(star_catalogue_file(name));
}

}  // namespace dmise
