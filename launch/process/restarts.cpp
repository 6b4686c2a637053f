#include "launch/process/restarts.h"

#include <algorithm>
#include <cstring>

namespace dmise {
namespace {

constexpr std::chrono::seconds between_starts{1};

}  // namespace

std::vector<std::string> Restarts::check(const RunStatus& status, Instant now) {
  std::vector<std::string> lines;
  if (network_.on_silent_node != OnSilentNode::restart || status.phase == Phase::failed ||
      status.phase == Phase::ended)
    return lines;
  for (const Child& child : processes_.children()) {
    const std::string why = reason(child, status, now);
    if (why.empty() || child.starts > network_.restarts) continue;
    processes_.restart(child.name);
    last_[child.name] = now;
    lines.push_back(child.name + " " + why + " and was restarted (" +
                    std::to_string(child.starts - 1) + " of " + std::to_string(network_.restarts) +
                    ")");
  }
  return lines;
}

/// Why the child is to be restarted; empty if it is not.
std::string Restarts::reason(const Child& child, const RunStatus& status, Instant now) const {
  if (child.name == "time-master") return "";  // the run cannot continue without it
  if (child.exit_code && *child.exit_code > killed_by)
    return std::string("was killed (") + strsignal(*child.exit_code - killed_by) + ")";
  const auto last = last_.find(child.name);
  const auto wait = last == last_.end() ? std::chrono::nanoseconds::max() : now - last->second;
  const auto known = std::ranges::find(status.nodes, child.name, &NodeStatus::name);
  // It was refused, as by a master that has not missed its predecessor, or could not begin. A
  // scenario that it can't use (2) stays the same.
  if (child.exit_code == 1) {
    if (wait < between_starts) return "";
    const bool missing = std::ranges::find(status.missing, child.name) != status.missing.end();
    if (missing || (known == status.nodes.end() && !status.nodes.empty()))
      return "has ended before it joined";
  } else if (std::chrono::duration<double>(wait).count() < network_.join_within_s) {
    return "";  // a process that was just started needs time to join
  }
  if (known != status.nodes.end() && !known->alive)
    return child.exit_code ? "has ended" : "was silent";
  return "";
}

}  // namespace dmise
