#include "nodes/runtime/log.h"

#include <spdlog/sinks/stdout_sinks.h>

#include "core/base/error.h"
#include "nodes/runtime/json_log.h"

namespace dmise {

void start_log(const std::string& name, const std::string& level, const std::string& format) {
  auto sink = std::make_shared<spdlog::sinks::stderr_sink_mt>();
  auto logger = std::make_shared<spdlog::logger>(name, sink);
  logger->set_pattern("%H:%M:%S.%e %n %l: %v");
  if (format == "json") logger->set_formatter(json_formatter());
  spdlog::set_default_logger(logger);  // first: what is wrong below is said in the log
  if (format != "json" && format != "text")
    throw ConfigError("log-format: must be text or json, got " + format);
  const auto parsed = spdlog::level::from_str(level);
  if (parsed == spdlog::level::off && level != "off")
    throw ConfigError("log-level: must be trace, debug, info, warning, error or off, got " + level);
  spdlog::set_level(parsed);
}

}  // namespace dmise
