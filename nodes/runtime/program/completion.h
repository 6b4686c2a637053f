#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace dmise {

// Scripts by which shells complete commands and options of a program, made from its tables. Where a
// word is neither, names of files are offered.
std::string bash_completion(const CLI::App& app);
std::string zsh_completion(const CLI::App& app);

}  // namespace dmise
