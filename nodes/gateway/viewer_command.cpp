#include "nodes/gateway/viewer_command.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

namespace dmise {
namespace {

using Json = nlohmann::json;

/// Whether an object has no keys but these.
bool has_only(const Json& object, const std::set<std::string>& keys) {
  for (const auto& [key, value] : object.items())
    if (!keys.contains(key)) return false;
  return true;
}

ViewerCommand read_step(const Json& object) {
  ClockCommand command{ClockCommand::Action::step, 1};
  if (const auto ticks = object.find("ticks"); ticks != object.end()) {
    if (!ticks->is_number_integer()) return CommandError{"ticks: must be a whole number"};
    // An unsigned number above the signed range becomes negative here, and is refused.
    command.ticks = ticks->get<std::int64_t>();
    if (command.ticks < 1 || command.ticks > max_step_ticks)
      return CommandError{"ticks: must be 1 to " + std::to_string(max_step_ticks)};
  }
  return command;
}

ViewerCommand read_pace(const Json& object) {
  const auto factor = object.find("factor");
  if (factor == object.end() || !factor->is_number())
    return CommandError{"factor: must be a number"};
  ClockCommand command{.action = ClockCommand::Action::pace, .factor = factor->get<double>()};
  if (!(command.factor >= 0.0 && command.factor <= max_pace_factor))
    return CommandError{"factor: must be 0 to 1e6"};
  return command;
}

ViewerCommand read_past(const Json& object) {
  const auto time = object.find("time_s");
  if (time == object.end() || !time->is_number()) return CommandError{"time_s: must be a number"};
  const double time_s = time->get<double>();
  if (!std::isfinite(time_s)) return CommandError{"time_s: must be finite"};
  return PastCommand{time_s};
}

}  // namespace

ViewerCommand parse_viewer_command(std::string_view text) {
  if (text.size() > max_command_bytes) return CommandError{"too long"};
  const Json object = Json::parse(text.begin(), text.end(), nullptr, false);
  if (!object.is_object()) return CommandError{"not a JSON object"};
  const auto verb = object.find("do");
  if (verb == object.end() || !verb->is_string()) return CommandError{"do: must be a text"};
  const auto& name = verb->get_ref<const std::string&>();
  const bool step = name == "step", past = name == "past", pace = name == "pace";
  const char* parameter = step ? "ticks" : past ? "time_s" : pace ? "factor" : "do";
  if (!has_only(object, {"do", parameter})) return CommandError{"unknown key"};
  if (step) return read_step(object);
  if (past) return read_past(object);
  if (pace) return read_pace(object);
  if (name == "pause") return ClockCommand{ClockCommand::Action::pause, 0};
  if (name == "go-on") return ClockCommand{ClockCommand::Action::go_on, 0};
  if (name == "live") return LiveCommand{};
  return CommandError{"do: must be pause, step, go-on, pace, past or live"};
}

}  // namespace dmise
