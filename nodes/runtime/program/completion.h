#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace dmise {

// Scripts for shells that complete commands and options of a program, and names of files elsewhere.
std::string bash_completion(const CLI::App& app);
std::string zsh_completion(const CLI::App& app);

}  // namespace dmise
