#include "nodes/runtime/log.h"

#include <spdlog/sinks/stdout_sinks.h>

#include "core/base/error.h"

namespace dmise {

void start_log(const std::string& name, const std::string& level) {
  const auto parsed = spdlog::level::from_str(level);
  if (parsed == spdlog::level::off && level != "off")
    throw ConfigError("log-level: must be trace, debug, info, warning, error or off, got " + level);
  spdlog::set_default_logger(
      std::make_shared<spdlog::logger>(name, std::make_shared<spdlog::sinks::stderr_sink_mt>()));
  spdlog::set_pattern("%H:%M:%S.%e %n %l: %v");
  spdlog::set_level(parsed);
}

}  // namespace dmise
