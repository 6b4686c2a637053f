#include "time-master/coordinator.h"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <set>

#include "core/base/error.h"

namespace dmise {
namespace {

constexpr Tick no_tick = std::numeric_limits<Tick>::max();

std::string in_seconds(Instant duration) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f s", std::chrono::duration<double>(duration).count());
  return text;
}

}  // namespace

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

Coordinator::Coordinator(CoordinatorOptions options, Instant now)
    : options_(std::move(options)), started_(now) {
  if (options_.window_ticks < 1) throw ConfigError("window_ticks: must be >= 1");
  if (options_.last_tick < 0) throw ConfigError("ticks: must be >= 1");
  if (options_.expected.empty()) throw ConfigError("expect: must name a node");
  auto names = options_.expected;
  std::sort(names.begin(), names.end());
  const auto twice = std::adjacent_find(names.begin(), names.end());
  if (twice != names.end()) throw ConfigError("two nodes are named " + *twice);
}

std::optional<std::string> Coordinator::join(const Request& request, Instant now) {
  const std::string& name = request.node.name;
  if (over()) return "the run is over";
  if (std::find(options_.expected.begin(), options_.expected.end(), name) ==
      options_.expected.end())
    return "this run has no node named " + name + "; it has " + joined(options_.expected);
  if (members_.contains(name)) return "a node named " + name + " has already joined";
  Member& member = members_[name];
  member.node = request.node;
  member.keeps_time = request.keeps_time;
  member.ready = !request.keeps_time;
  member.progressed = now;
  heard(member, now);
  connect_if_complete();
  return std::nullopt;
}

void Coordinator::connect_if_complete() {
  if (phase_ != Phase::gathering || !missing().empty()) return;
  std::vector<NodeTopics> nodes;
  for (const std::string& name : options_.expected) nodes.push_back(members_.at(name).node);
  if (const auto fault = topic_fault(nodes)) return fail_run(*fault);
  phase_ = Phase::connecting;
  start_if_ready();
}

void Coordinator::ready(const std::string& name, Instant now) {
  Member* member = active(name);
  if (!member) return;
  heard(*member, now);
  member->ready = true;
  start_if_ready();
}

void Coordinator::start_if_ready() {
  if (phase_ != Phase::connecting || !holding().empty()) return;
  phase_ = Phase::running;
  grant();
}

void Coordinator::done(const std::string& name, Tick tick, Instant now) {
  Member* member = active(name);
  if (!member || over()) return;
  heard(*member, now);
  if (tick <= member->done) return;  // said twice
  if (tick != member->done + 1 || tick > granted_)
    return fail_run(name + ": tick " + std::to_string(tick) + " is done, but " +
                    std::to_string(member->done + 1) + " was next and " + std::to_string(granted_) +
                    " the last granted");
  member->done = tick;
  member->progressed = now;
  grant();
}

void Coordinator::grant() {
  if (phase_ != Phase::running) return;
  const Tick slowest = slowest_done();
  if (slowest == no_tick) return fail_run("no node is left");
  if (slowest >= options_.last_tick) {
    phase_ = Phase::ended;
    return;
  }
  granted_ = std::max(granted_, std::min(slowest + options_.window_ticks, options_.last_tick));
}

void Coordinator::heartbeat(const std::string& name, bool computing, std::uint64_t progress,
                            Instant now) {
  Member* member = active(name);
  if (!member) return;
  heard(*member, now);
  if (!computing || !member->computing || progress != member->progress) member->progressed = now;
  member->computing = computing;
  member->progress = progress;
}

void Coordinator::heard(Member& member, Instant now) {
  member.heard = now;
  member.suspected.reset();
  member.silent = false;
}

void Coordinator::suspect(const std::string& name, Instant now) {
  Member* member = active(name);
  if (member && !member->suspected) member->suspected = now;
}

void Coordinator::leave(const std::string& name, bool interrupted) {
  Member* member = active(name);
  if (!member) return;
  if (over()) {
    member->left = true;
    return;
  }
  const std::string how = interrupted ? "was interrupted" : "left before the end";
  if (phase_ == Phase::gathering) {
    members_.erase(name);
    return;
  }
  member->left = true;
  if (options_.on_silent == SilentPolicy::drop && member->keeps_time)
    drop(*member);
  else
    fail_run(name + " " + how + " (last tick done: " + std::to_string(member->done) + " of " +
             std::to_string(options_.last_tick) + ")");
}

void Coordinator::fail(const std::string& name, const std::string& reason) {
  Member* member = active(name);
  if (!member) return;
  member->left = true;
  if (options_.on_silent == SilentPolicy::drop && member->keeps_time && phase_ == Phase::running)
    drop(*member);
  else
    fail_run(name + ": " + reason);
}

void Coordinator::stop(const std::string& reason) { fail_run(reason); }

void Coordinator::check(Instant now) {
  if (!over() && phase_ != Phase::running && options_.start_within.count() > 0 &&
      now - started_ > options_.start_within)
    return fail_run("not started within " + in_seconds(options_.start_within) + ": waiting for " +
                    joined(holding()));
  std::vector<std::string> names;  // lost() may take a member away
  for (const auto& [name, member] : members_) names.push_back(name);
  for (const std::string& name : names) {
    Member* member = active(name);
    if (!member || member->silent) continue;
    const Instant silence = now - member->heard;
    if (silence > options_.silent_after)
      lost(*member, "has been silent for " + in_seconds(silence));
    else if (member->suspected && now - *member->suspected > options_.suspect_after)
      lost(*member, "has closed its connection");
    else if (member->computing && options_.progress_after.count() > 0 &&
             now - member->progressed > options_.progress_after && !over())
      lost(*member, "has made no progress for " + in_seconds(now - member->progressed));
  }
}

void Coordinator::lost(Member& member, const std::string& how) {
  if (over()) {
    member.left = true;
    return;
  }
  if (phase_ == Phase::gathering) {
    members_.erase(std::string(member.node.name));
    return;
  }
  if (!member.keeps_time || options_.on_silent == SilentPolicy::fail ||
      phase_ == Phase::connecting) {
    member.left = true;
    fail_run(member.node.name + " " + how + " (last tick done: " + std::to_string(member.done) +
             " of " + std::to_string(options_.last_tick) + ")");
  } else if (options_.on_silent == SilentPolicy::wait) {
    member.silent = true;
  } else {
    drop(member);
  }
}

void Coordinator::drop(Member& member) {
  member.left = true;
  member.dropped = true;
  // It may have died with messages of ticks that it called done: they count for nobody who is
  // behind.
  member.closed_from = std::min(member.done, slowest_done()) + 1;
  grant();
}

void Coordinator::fail_run(const std::string& cause) {
  if (over()) return;
  phase_ = Phase::failed;
  cause_ = cause;
}

Coordinator::Member* Coordinator::active(const std::string& name) {
  const auto found = members_.find(name);
  return found != members_.end() && found->second.active() ? &found->second : nullptr;
}

std::vector<std::string> Coordinator::missing() const {
  std::vector<std::string> names;
  for (const std::string& name : options_.expected)
    if (!members_.contains(name)) names.push_back(name);
  return names;
}

std::vector<std::string> Coordinator::holding() const {
  if (phase_ == Phase::gathering) return missing();
  std::vector<std::string> names;
  if (phase_ == Phase::connecting) {
    for (const std::string& name : options_.expected)
      if (!members_.at(name).ready) names.push_back(name);
    return names;
  }
  if (over()) return names;
  for (const auto& [name, member] : members_)
    if (member.silent) names.push_back(name);
  if (!names.empty()) return names;
  const Tick slowest = slowest_done();
  std::set<std::string> late_topics;  // of those who are behind
  const auto behind = [&](const Member& member) {
    return member.keeps_time && member.active() && member.done == slowest;
  };
  for (const auto& [name, member] : members_)
    if (behind(member))
      late_topics.insert(member.node.produces.begin(), member.node.produces.end());
  for (const std::string& name : options_.expected) {
    const Member& member = members_.at(name);
    const auto& needs = member.node.consumes;
    const bool waits = std::any_of(needs.begin(), needs.end(), [&](const std::string& topic) {
      return late_topics.contains(topic);
    });
    if (behind(member) && !waits) names.push_back(name);
  }
  return names;
}

Tick Coordinator::slowest_done() const {
  Tick slowest = no_tick;
  for (const auto& [name, member] : members_)
    if (member.keeps_time && member.active()) slowest = std::min(slowest, member.done);
  return slowest;
}

bool Coordinator::deserted() const {
  return std::none_of(members_.begin(), members_.end(),
                      [](const auto& entry) { return entry.second.active(); });
}

}  // namespace dmise
