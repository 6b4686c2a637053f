#pragma once
#include <spdlog/spdlog.h>

#include <string>

namespace dmise {

/// Sends the log of this process to stderr, one event per line, under `name`. `level`: trace,
/// debug, info, warning, error, off. `format`: "text" or "json" (json_log.h). Throws `ConfigError`
/// for other values.
void start_log(const std::string& name, const std::string& level = "info",
               const std::string& format = "text");

}  // namespace dmise
