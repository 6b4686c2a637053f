#pragma once
#include <string>
#include <vector>

namespace dmise {

/// Root of the installation or checkout: `$DMISE_HOME`, else found upwards from the running
/// program.
std::string home_directory();

/// `name` looked for as a path beside `from_file` and as it stands, then as a preset
/// `<home>/launch/<kind>/<name>.yaml`. Empty if there is none.
std::string find_preset(const std::string& kind, const std::string& name,
                        const std::string& from_file);
std::vector<std::string> preset_names(const std::string& kind);

/// A file that a scenario names: beside the scenario or as it stands; empty if there is none.
std::string find_beside(const std::string& name, const std::string& from_file);

/// Debian's catalogues: "stars.dat" (kstars-data) and "satellites.dat" (gpredict), as the set-up
/// unpacks them or as the packages install them. Empty if absent.
std::string find_catalogue(const std::string& file_name);

}  // namespace dmise
