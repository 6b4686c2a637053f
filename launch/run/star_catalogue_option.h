#pragma once
#include <CLI/CLI.hpp>
#include <string>

#include "core/config/load_star_catalogue.h"

namespace dmise {

/// Adds `--catalogue`: kstars (the default), tycho2, a file or, if `may_be_none`, `none`.
CLI::Option* add_star_catalogue_option(CLI::App& command, std::string& name, bool may_be_none);

}  // namespace dmise
