#include "nodes/runtime/process/json_log.h"

#include <spdlog/fmt/chrono.h>
#include <spdlog/formatter.h>

#include <nlohmann/json.hpp>

namespace dmise {
namespace {

using Json = nlohmann::ordered_json;

struct LoggedEvent {
  std::string_view name;
  std::initializer_list<LogField> fields;
};

// The event being logged by this thread; without a queue it is formatted before `log` returns.
thread_local const LoggedEvent* current_event = nullptr;

std::string rfc3339(spdlog::log_clock::time_point time) {
  const auto us = std::chrono::floor<std::chrono::microseconds>(time.time_since_epoch());
  const auto s = std::chrono::floor<std::chrono::seconds>(us);
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:06}Z", fmt::gmtime(std::time_t(s.count())),
                     (us - s).count());
}

std::string text_of(spdlog::string_view_t view) { return {view.data(), view.size()}; }

class JsonFormatter : public spdlog::formatter {
 public:
  void format(const spdlog::details::log_msg& message, spdlog::memory_buf_t& out) override {
    Json line;
    line["time"] = rfc3339(message.time);
    line["level"] = text_of(spdlog::level::to_string_view(message.level));
    line["node"] = text_of(message.logger_name);
    line["event"] = current_event ? current_event->name : "message";
    line["text"] = text_of(message.payload);
    Json& fields = line["fields"] = Json::object();
    if (current_event)
      for (const auto& [key, value] : current_event->fields)
        std::visit([&, k = std::string(key)](const auto& v) { fields[k] = v; }, value);
    const std::string text = line.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
    out.append(text.data(), text.data() + text.size());
  }
  std::unique_ptr<spdlog::formatter> clone() const override {
    return std::make_unique<JsonFormatter>();
  }
};

}  // namespace

void log_event(spdlog::level::level_enum level, std::string_view event,
               std::initializer_list<LogField> fields, const std::string& text) {
  const LoggedEvent now{event, fields};
  current_event = &now;
  spdlog::log(level, "{}", text);
  current_event = nullptr;
}

std::unique_ptr<spdlog::formatter> json_formatter() { return std::make_unique<JsonFormatter>(); }

}  // namespace dmise
