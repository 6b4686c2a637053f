#pragma once
#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "core/sky/star_map.h"

namespace dmise {

/// Adds `--catalogue`: kstars (the default), tycho2, a file or, if `may_be_none`, `none`.
CLI::Option* add_star_catalogue_option(CLI::App& command, std::string& name, bool may_be_none);

/// Loads the catalogue of that name through the user's cache; null for "none", the default for "".
/// Throws `ConfigError`.
std::shared_ptr<const StarMap> load_star_catalogue(const std::string& name);

}  // namespace dmise
