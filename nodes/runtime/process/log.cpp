#include "nodes/runtime/process/log.h"

#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/stdout_sinks.h>

#include "core/base/error.h"
#include "core/base/nearest_name.h"
#include "core/base/printable.h"
#include "nodes/runtime/process/json_log.h"

namespace dmise {

namespace {

/// The text of an event on one line without control characters: names in it come from files and
/// from the network.
class PrintablePayload : public spdlog::custom_flag_formatter {
 public:
  void format(const spdlog::details::log_msg& message, const std::tm&,
              spdlog::memory_buf_t& out) override {
    const std::string text = printable({message.payload.data(), message.payload.size()}, longest);
    out.append(text.data(), text.data() + text.size());
  }
  std::unique_ptr<spdlog::custom_flag_formatter> clone() const override {
    return std::make_unique<PrintablePayload>();
  }

 private:
  static constexpr std::size_t longest = 4000;  // [bytes]
};

std::unique_ptr<spdlog::formatter> text_formatter() {
  auto formatter = std::make_unique<spdlog::pattern_formatter>();
  formatter->add_flag<PrintablePayload>('*').set_pattern("%H:%M:%S.%e %n %l: %*");
  return formatter;
}

}  // namespace

void start_log(const std::string& name, const std::string& level, const std::string& format) {
  auto sink = std::make_shared<spdlog::sinks::stderr_sink_mt>();
  auto logger = std::make_shared<spdlog::logger>(name, sink);
  logger->set_formatter(format == "json" ? json_formatter() : text_formatter());
  spdlog::set_default_logger(logger);  // first, so that errors below are logged
  if (format != "json" && format != "text")
    throw ConfigError("log-format: must be text or json" + did_you_mean(format, {"text", "json"}) +
                      ", got " + format);
  const auto parsed = spdlog::level::from_str(level);
  if (parsed == spdlog::level::off && level != "off")
    throw ConfigError("log-level: must be trace, debug, info, warning, error or off" +
                      did_you_mean(level, {"trace", "debug", "info", "warning", "error", "off"}) +
                      ", got " + level);
  spdlog::set_level(parsed);
}

}  // namespace dmise
