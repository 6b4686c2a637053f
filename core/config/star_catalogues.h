#pragma once
#include <string>

namespace dmise {

/// The file of a star catalogue that has a name, for `find_catalogue`; null for any other name.
const char* star_catalogue_file(const std::string& name);

/// The same on every host, whatever was fetched there.
inline constexpr const char* default_star_catalogue = "kstars";

/// What to say of a named catalogue that is absent.
std::string missing_star_catalogue(const std::string& name);

}  // namespace dmise
