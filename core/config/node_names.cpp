#include "core/config/node_names.h"

#include <algorithm>
#include <iterator>
#include <string_view>

#include "core/config/node_kinds.h"

namespace dmise {
namespace {

constexpr std::size_t longest = 64;

// Names of other members of the network, and of directories of runs and keys.
constexpr std::string_view members[] = {"time-master", "broker", "operator", "host-agent",
                                        "gateway"};
constexpr std::string_view directories[] = {"logs", "positions", "rings", "export"};

bool is_member(const std::string& name) {
  return std::ranges::find(members, name) != std::end(members) ||
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

std::optional<std::string> NodeNames::fault_of(const std::string& name) {
  if (auto fault = fault_of_name(name)) return fault;
  const std::string lower = lower_case(name);
  if (std::ranges::find(directories, lower) != std::end(directories))
    return "a directory of the run has this name";
  if (is_member(lower)) return "another node has this name";
  const auto [other, is_new] = taken_.emplace(lower, name);
  if (is_new) return std::nullopt;
  return "another node has this name" +
         (other->second == name ? "" : " but for upper and lower case: " + other->second);
}

}  // namespace dmise
