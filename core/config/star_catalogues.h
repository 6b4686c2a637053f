#pragma once
#include <string>

namespace dmise {

/// Returns the file of a star catalogue by name, for `find_catalogue`; null for an unknown name.
const char* star_catalogue_file(const std::string& name);

/// The catalogue of scenarios that name none. It does not depend on what a host has fetched.
inline constexpr const char* default_star_catalogue = "kstars";

/// Returns the message about a named catalogue that is absent.
std::string missing_star_catalogue(const std::string& name);

}  // namespace dmise
