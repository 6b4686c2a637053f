#include "bench/catalogue_file.h"

#include <cstdlib>
#include <fstream>

#include "core/orbit/elements/element_text.h"
#include "core/orbit/sgp4/synthetic_catalogue.h"

namespace dmise {

WrittenCatalogue catalogue_of_18470(const std::filesystem::path& directory) {
  if (const char* data = std::getenv("DMISE_DATA")) {
    const std::string path = std::string(data) + "/tle/catalog_3le_2019-12-19_18470.txt.gz";
    if (std::filesystem::exists(path)) return {path, "2019-12-20T00:15:00Z"};
  }
  std::ofstream(directory / "objects.tle")
      << format_3le(synthetic_catalogue({.objects = 18470, .seed = 1}));
  return {(directory / "objects.tle").string(), "2018-01-20T00:15:00Z"};
}

}  // namespace dmise
