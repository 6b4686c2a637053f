#pragma once
#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "core/sky/star_map.h"

namespace dmise {

/// Adds `--catalogue`: kstars (the default), tycho2 or a file; `none`, if that may be said.
CLI::Option* add_star_catalogue_option(CLI::App& command, std::string& name, bool may_be_none);

/// The catalogue of that name, with its cache; null for "none", the default for "". Throws
/// `ConfigError`.
std::shared_ptr<const StarMap> load_star_catalogue(const std::string& name);

}  // namespace dmise
