#include "time-master/clock_watch.h"

#include <algorithm>

#include "core/base/printable.h"
#include "nodes/runtime/process/json_log.h"

namespace dmise {
namespace {

constexpr std::chrono::seconds patience{5};

void log_lost(const std::string& name, Tick done, const std::string& what_follows) {
  log_event(spdlog::level::warn, "node_lost", {{"name", name}, {"done_tick", done}},
            fmt::format("{} is lost: {} (last tick done: {})", name, what_follows, done));
}

}  // namespace

void ClockWatch::check(const Coordinator& coordinator, Instant now) {
  if (coordinator.over()) return;
  const auto all = {&coordinator.members(), &coordinator.behind()};
  for (const std::string& name : joined_)
    if (std::ranges::none_of(all, [&](const auto* some) { return some->contains(name); }))
      log_lost(name, -1, "waiting for another process of its name");
  joined_.clear();
  for (const auto* members : all)
    for (const auto& [name, member] : *members) {
      if (member.is_guest()) continue;
      joined_.insert(name);
      if (!member.silent && !member.dropped) lost_.erase(name);
      if (member.silent && lost_.insert(name).second) log_lost(name, member.done, "waiting for it");
      if (member.dropped && lost_.insert(name).second)
        log_lost(name, member.done, "the run goes on without it");
    }
  const auto state = std::pair(coordinator.granted(), coordinator.holding());
  if (state != seen_) {
    seen_ = state;
    quiet_since_ = now;
  } else if (now - quiet_since_ >= patience) {
    const std::string holding = joined(state.second);
    const bool paused = coordinator.paused();
    log_event(
        spdlog::level::info, "clock_held",
        {{"granted_tick", coordinator.granted()},
         {"last_tick", coordinator.options().last_tick},
         {"holding", holding},
         {"paused", paused}},
        fmt::format("tick {} of {}: {}", coordinator.granted(), coordinator.options().last_tick,
                    !holding.empty() ? "waiting for " + holding
                    : paused         ? "paused"
                                     : "waiting for real time"));
    quiet_since_ = now;
  }
}

}  // namespace dmise
