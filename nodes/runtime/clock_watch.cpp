#include "nodes/runtime/clock_watch.h"

#include "nodes/runtime/json_log.h"

namespace dmise {
namespace {

constexpr std::chrono::seconds patience{5};

}  // namespace

void ClockWatch::look(const Coordinator& coordinator, Instant now) {
  if (coordinator.over()) return;
  for (const auto& [name, member] : coordinator.members()) {
    if (!member.silent) silent_.erase(name);
    if (member.silent && silent_.insert(name).second)
      log_event(spdlog::level::warn, "node_lost", {{"name", name}, {"done_tick", member.done}},
                fmt::format("{} is lost: waiting for it (last tick done: {})", name, member.done));
  }
  const auto state = std::pair(coordinator.granted(), coordinator.holding());
  if (state != seen_) {
    seen_ = state;
    quiet_since_ = now;
  } else if (now - quiet_since_ >= patience) {
    const std::string holding = joined(state.second);
    const bool paused = coordinator.pace().paused();
    log_event(
        spdlog::level::info, "clock_held",
        {{"granted_tick", coordinator.granted()},
         {"last_tick", coordinator.options().last_tick},
         {"holding", holding},
         {"paused", paused}},
        fmt::format("tick {} of {}: {}", coordinator.granted(), coordinator.options().last_tick,
                    !holding.empty() ? "waiting for " + holding
                    : paused         ? "paused"
                                     : "real time holds the clock"));
    quiet_since_ = now;
  }
}

}  // namespace dmise
