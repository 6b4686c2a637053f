#include "nodes/runtime/clock_watch.h"

#include <spdlog/spdlog.h>

namespace dmise {
namespace {

constexpr std::chrono::seconds patience{5};

}  // namespace

void ClockWatch::look(const Coordinator& coordinator, Instant now) {
  if (coordinator.over()) return;
  for (const auto& [name, member] : coordinator.members()) {
    if (!member.silent) silent_.erase(name);
    if (member.silent && silent_.insert(name).second)
      spdlog::warn("{} is lost: waiting for it (last tick done: {})", name, member.done);
  }
  const auto state = std::pair(coordinator.granted(), coordinator.holding());
  if (state != seen_) {
    seen_ = state;
    quiet_since_ = now;
  } else if (now - quiet_since_ >= patience) {
    spdlog::info("tick {} of {}: {}", coordinator.granted(), coordinator.options().last_tick,
                 !state.second.empty()         ? "waiting for " + joined(state.second)
                 : coordinator.pace().paused() ? std::string("paused")
                                               : std::string("real time holds the clock"));
    quiet_since_ = now;
  }
}

}  // namespace dmise
