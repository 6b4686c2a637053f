#include "launch/dataset/dataset_digest.h"

#include <set>

#include "core/base/error.h"
#include "core/base/files/digest.h"
#include "core/base/version.h"
#include "launch/run/file_digest.h"

namespace dmise {

std::string dataset_digest(const ScenarioDraws& draws) {
  Sha256 sha;
  sha.update(software_name() + "\n" + draws.text());
  std::set<std::string> files;
  draws.check_ends([&](const Scenario& scenario) {
    sha.update("\n" + physics_json(scenario));
    for (const auto& path : files_of(scenario.objects, scenario.own_objects)) files.insert(path);
    files.insert(scenario.star_catalogue_path);
    files.insert(scenario.star_variables_path);
    files.insert(scenario.earth_orientation_path);
  });
  for (const auto& path : files)
    if (!path.empty()) sha.update("\n" + file_digest(path));
  return sha.hex().substr(0, 32);
}

void check_output_of_dataset(const Scenario& scenario) {
  const OutputConfig& output = scenario.output;
  const char* unknown = output.fits_rice                                      ? "fits.compression"
                        : output.saturation                                   ? "saturation"
                        : output.radiance_exr                                 ? "radiance_exr"
                        : output.sources || output.background || output.noise ? "planes"
                        : output.star_truth                                   ? "star_truth"
                        : output.positions()                                  ? "positions"
                                                                              : nullptr;
  if (unknown)
    throw ConfigError(scenario.path + ": output." + unknown + ": is for runs, not for data sets");
  if (scenario.fusion)
    throw ConfigError(scenario.fusion->where + ": is for runs, not for data sets");
}

}  // namespace dmise
