#include "core/config/node_names.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "core/config/node_kinds.h"

namespace dmise {
namespace {

constexpr std::size_t longest = 64;

// Names taken by other members of the network and by directories of runs and keys.
constexpr std::array<std::string_view, 7> reserved = {
    "time-master", "broker", "operator", "host-agent", "logs", "positions", "rings"};

bool is_reserved(const std::string& name) {
  return std::ranges::find(reserved, name) != reserved.end() ||
         std::ranges::any_of(node_kinds(), [&](const NodeKind& kind) {
           return !kind.each_sensor && name == kind.name;
         });
}

std::string lower_case(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
  return text;
}

bool is_allowed(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
         c == '_';
}

}  // namespace

std::optional<std::string> fault_of_name(const std::string& name) {
  if (name.empty() || name.size() > longest || !std::all_of(name.begin(), name.end(), is_allowed))
    return "must be at most 64 letters, digits, - and _";
  if (name.front() == '-') return "must not begin with -";
  return std::nullopt;
}

std::optional<std::string> SensorNames::fault_of(const std::string& name) {
  if (auto fault = fault_of_name(name)) return fault;
  const std::string lower = lower_case(name);
  for (const std::string_view own : {"logs", "positions", "rings"})
    if (lower == own) return "a directory of the run has this name";
  if (is_reserved(lower)) return "another node has this name";
  const auto [other, is_new] = taken_.emplace(lower, name);
  if (is_new) return std::nullopt;
  return "another node has this name" +
         (other->second == name ? "" : " but for upper and lower case: " + other->second);
}

}  // namespace dmise
