#pragma once
#include <spdlog/spdlog.h>

#include <string>

namespace dmise {

/// Sends the log of this process to stderr, one event a line, under `name`. `level`: trace, debug,
/// info, warning, error, off. Throws `ConfigError` for another word.
void start_log(const std::string& name, const std::string& level = "info");

}  // namespace dmise
