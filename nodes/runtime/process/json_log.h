#pragma once
#include <spdlog/spdlog.h>

#include <cstdint>
#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

namespace dmise {

using LogValue = std::variant<std::int64_t, std::uint64_t, double, bool, std::string>;
using LogField = std::pair<std::string_view, LogValue>;

/// Logs `text`. In a JSON log the line also has `event`, a name independent of the wording, and
/// `fields`, the values in the text.
void log_event(spdlog::level::level_enum level, std::string_view event,
               std::initializer_list<LogField> fields, const std::string& text);

/// Formats an event as one line of JSON (RFC 8259) with the keys
///   time    UTC, RFC 3339 with microseconds: "2026-01-31T12:00:00.000000Z"
///   level   trace, debug, info, warning, error or critical
///   node    the log's name
///   event   what `log_event` was given; "message" for all other lines
///   text    the sentence that the text format shows
///   fields  an object, perhaps empty
/// Bytes that are not UTF-8 become U+FFFD.
std::unique_ptr<spdlog::formatter> json_formatter();

}  // namespace dmise
