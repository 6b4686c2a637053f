// Agents and the nodes behind them: the clock waits for a host, but knows each of its nodes.
#include <algorithm>

#include "time-master/coordinator.h"

namespace dmise {
namespace {

void add_each(std::vector<std::string>* topics, const std::vector<std::string>& more) {
  for (const std::string& topic : more)
    if (std::find(topics->begin(), topics->end(), topic) == topics->end()) topics->push_back(topic);
}

}  // namespace

std::optional<std::string> Coordinator::join_agent(const Request& request, Instant now) {
  const std::string& name = request.node.name;
  if (is_expected(name)) return name + " is a node of this run and can't be the name of an agent";
  if (options_.on_silent == SilentPolicy::drop)
    return "a run that continues without lost nodes (drop) can't have agents";
  const auto earlier = members_.find(name);
  if (earlier == members_.end()) {
    if (phase_ != Phase::gathering) return "the run has started: no agent may join";
    const auto agents = std::count_if(members_.begin(), members_.end(),
                                      [](const auto& entry) { return entry.second.agent; });
    if (std::size_t(agents) >= options_.expected.size())
      return "as many agents have joined as there are nodes";
    add(request, now);
    return std::nullopt;
  }
  Member& agent = earlier->second;
  const bool gone = agent.active() && (agent.silent || agent.pulse.suspected);
  if (!agent.agent || !gone ||
      (phase_ != Phase::gathering && options_.on_silent != SilentPolicy::wait))
    return "an agent named " + name + " has already joined";
  if (phase_ == Phase::gathering) {
    forget(name);
    add(request, now);
    return std::nullopt;
  }
  if (auto refusal = take_place(agent, now)) return refusal;
  agent.waits_for.clear();
  for (auto& [node, member] : behind_)
    if (member.host == name && !member.silent) silence(member, now);
  return std::nullopt;
}

std::optional<std::string> Coordinator::join_behind(const Request& request, Instant now) {
  const std::string& name = request.node.name;
  const auto host = members_.find(request.host);
  if (host == members_.end() || !host->second.agent) return "no agent named " + request.host;
  Member& agent = host->second;
  if (!is_expected(name)) return not_expected(name);
  if (!request.keeps_time || request.observer)
    return name + " can't join behind an agent: it must keep time";
  const auto earlier = behind_.find(name);
  if (earlier != behind_.end() && earlier->second.silent && earlier->second.host == request.host &&
      options_.on_silent == SilentPolicy::wait) {
    agent.ready = false;
    if (auto refusal = rejoin(earlier->second, request, now)) return refusal;
    silent_behind_.erase(name);
    agent.done = std::min(agent.done, earlier->second.done);
    return std::nullopt;
  }
  if (members_.contains(name) || earlier != behind_.end())
    return "a node named " + name + " has already joined";
  behind_[name] = fresh(request, now);
  agent.pulse.heard_at(now);
  add_each(&agent.node.produces, request.node.produces);
  add_each(&agent.node.consumes, request.node.consumes);
  connect_if_complete(now);
  return std::nullopt;
}

Coordinator::Member* Coordinator::behind(const std::string& name, std::uint64_t incarnation) {
  const auto found = behind_.find(name);
  return found != behind_.end() && found->second.incarnation == incarnation ? &found->second
                                                                            : nullptr;
}

void Coordinator::lost_behind(const std::string& name, std::uint64_t incarnation,
                              const std::string& how, Tick done, Instant now) {
  Member* member = behind(name, incarnation);
  if (!member || over()) return;
  if (phase_ == Phase::gathering) {
    forgotten_.push_back(name);
    behind_.erase(name);
    return;
  }
  member->done = std::max(member->done, done);
  wait_or_fail(*member, how, now);
}

void Coordinator::found_behind(const std::string& name, std::uint64_t incarnation) {
  Member* member = behind(name, incarnation);
  if (!member) return;
  member->silent = false;
  silent_behind_.erase(name);
}

void Coordinator::fail_behind(const std::string& name, std::uint64_t incarnation,
                              const std::string& reason) {
  if (behind(name, incarnation)) fail_run(name + ": " + reason);
}

void Coordinator::report_behind(const std::string& agent, std::vector<std::string> waits_for,
                                const std::map<std::string, Tick>& done) {
  if (Member* member = active(agent)) member->waits_for = std::move(waits_for);
  for (const auto& [name, tick] : done)
    if (const auto found = behind_.find(name);
        found != behind_.end() && found->second.host == agent)
      found->second.done = tick;
}

void Coordinator::forget(const std::string& name) {
  for (const std::string& node : nodes_behind(name)) {
    forgotten_.push_back(node);
    behind_.erase(node);
  }
  std::erase_if(silent_behind_, [&](const auto& node) { return !behind_.contains(node); });
  const auto member = members_.find(name);
  if (member == members_.end()) return;
  // Names of observers and agents are unlimited: their counters are not kept.
  if (!is_expected(name)) incarnations_.erase(name);
  forgotten_.push_back(member->first);
  members_.erase(member);
}

void Coordinator::set_idle_agents() {
  for (auto& [name, member] : members_) {
    if (!member.agent || !nodes_behind(name).empty()) continue;
    member.idle = member.ready = true;
    member.keeps_time = false;
  }
}

std::vector<std::string> Coordinator::nodes_behind(const std::string& agent) const {
  std::vector<std::string> names;
  for (const auto& [name, member] : behind_)
    if (member.host == agent) names.push_back(name);
  return names;
}

}  // namespace dmise
