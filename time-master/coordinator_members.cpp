// Joining, replacing and observing, and the start of a run.
#include <algorithm>

#include "core/base/printable.h"
#include "time-master/coordinator.h"

namespace dmise {

std::optional<std::string> Coordinator::join(const Request& request, Instant now) {
  const std::string& name = request.node.name;
  if (over()) return "the run is over";
  if (request.node.schedule.period < 1 || request.node.schedule.offset < 0 ||
      request.node.look_back < 0)
    return "its period must be >= 1, its offset and look-back >= 0";
  if (request.observer) return observe(request, now);
  if (request.agent) return join_agent(request, now);
  if (!request.host.empty()) return join_behind(request, now);
  if (!is_expected(name)) return not_expected(name);
  if (behind_.contains(name)) return "a node named " + name + " has already joined";
  if (const auto earlier = members_.find(name); earlier != members_.end()) {
    const Member& member = earlier->second;
    const bool gone = member.silent || member.pulse.suspected;
    if (phase_ != Phase::gathering && gone && member.active() &&
        options_.on_silent == SilentPolicy::wait)
      return rejoin(earlier->second, request, now);
    if (phase_ != Phase::gathering || !gone) return "a node named " + name + " has already joined";
  }
  add(request, now);
  connect_if_complete(now);
  return std::nullopt;
}

bool Coordinator::is_expected(const std::string& name) const {
  return std::ranges::find(options_.expected, name) != options_.expected.end();
}

std::string Coordinator::not_expected(const std::string& name) const {
  return "this run has no node named " + name + "; it has " + joined(options_.expected);
}

Coordinator::Member Coordinator::fresh(const Request& request, Instant now) {
  Member member{request};
  member.keeps_time = request.keeps_time && !request.observer;
  member.ready = !member.keeps_time;
  member.incarnation = ++incarnations_[request.node.name];
  member.resumes_at = settled_ + 1;
  member.done = settled_;
  member.pulse = Pulse::begin(now);
  heard(member, now);
  return member;
}

std::optional<std::string> Coordinator::observe(const Request& request, Instant now) {
  const std::string& name = request.node.name;
  if (is_expected(name))
    return name + " is a node of this run and can't be the name of an observer";
  if (members_.contains(name)) return "an observer named " + name + " has already joined";
  if (!request.node.produces.empty()) return "an observer publishes nothing";
  const auto watching = std::count_if(members_.begin(), members_.end(),
                                      [](const auto& entry) { return entry.second.observer; });
  if (std::size_t(watching) >= options_.max_observers)
    return std::to_string(watching) +
           " observers have joined already: another may join when one leaves";
  add(request, now);
  return std::nullopt;
}

std::optional<std::string> Coordinator::rejoin(Member& member, const Request& request,
                                               Instant now) {
  const std::string& name = request.node.name;
  const NodeTopics& before = member.node;
  if (before.produces != request.node.produces || before.consumes != request.node.consumes ||
      before.look_back != request.node.look_back || !(before.schedule == request.node.schedule) ||
      before.delays != request.node.delays || member.keeps_time != request.keeps_time)
    return name + " rejoins with other topics than before";
  if (auto refusal = take_place(member, now)) return refusal;
  ++topology_version_;
  start_if_ready(now);
  return std::nullopt;
}

std::optional<std::string> Coordinator::take_place(Member& member, Instant now) {
  const std::string& name = member.node.name;
  if (options_.max_rejoins >= 0 && member.incarnation > std::uint64_t(options_.max_rejoins)) {
    fail_run(name + " has died " + std::to_string(member.incarnation) + " times");
    return "the run is over";
  }
  member.incarnation = ++incarnations_[name];
  // It may have died with messages of ticks that it reported as done: it repeats what anybody may
  // still need. Their tallies are kept for comparison.
  member.resumes_at = settled_ + 1;
  member.done = member.resumes_at - 1;
  member.pulse = Pulse::begin(now);
  member.ready = !member.keeps_time;
  heard(member, now);
  return std::nullopt;
}

void Coordinator::connect_if_complete(Instant now) {
  if (phase_ != Phase::gathering || !missing().empty()) return;
  std::vector<NodeTopics> nodes;
  for (const std::string& name : options_.expected) nodes.push_back(member_of(name).node);
  if (const auto fault = topic_fault(nodes)) return fail_run(*fault);
  history_ = history_ticks(nodes);
  set_idle_agents();
  phase_ = Phase::connecting;
  ++topology_version_;
  start_if_ready(now);
}

void Coordinator::ready(const std::string& name, Instant now) {
  Member* member = active(name);
  if (!member) return;
  heard(*member, now);
  member->ready = true;
  start_if_ready(now);
}

void Coordinator::start_if_ready(Instant now) {
  if (phase_ != Phase::connecting || !holding().empty()) return;
  phase_ = Phase::running;
  pace_.start(now);
  grant(now);
}

}  // namespace dmise
