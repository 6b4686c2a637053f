#include "time-master/master_messages.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "core/base/printable.h"
#include "nodes/runtime/process/seconds.h"

namespace dmise {

static_assert(int(Phase::gathering) == v1::PHASE_GATHERING &&
              int(Phase::failed) == v1::PHASE_FAILED);

Coordinator::Request request_of(const v1::Join& join) {
  Coordinator::Request request;
  request.node = {.name = join.name(),
                  .produces = {join.produces().begin(), join.produces().end()},
                  .consumes = {join.consumes().begin(), join.consumes().end()},
                  .look_back = Tick(join.look_back_ticks()),
                  .schedule = {.period = Tick(std::max<std::uint64_t>(1, join.period_ticks())),
                               .offset = Tick(join.offset_ticks())}};
  request.node.produces.insert(request.node.produces.end(), join.produces_direct().begin(),
                               join.produces_direct().end());
  for (const auto& of : join.delays()) request.node.delays[of.topic()] = Tick(of.delay_ticks());
  request.keeps_time = !join.has_broker() && !join.observer();
  request.observer = join.observer();
  request.agent = join.agent();
  request.host = join.host();
  return request;
}

TickTally tally_of(const v1::Done& done) {
  TickTally tally{done.tick(), {}, done.digest()};
  for (const auto& topic : done.published())
    tally.topics.push_back({topic.topic(), topic.messages(), topic.last_sequence(), topic.digest(),
                            topic.incarnation()});
  return tally;
}

void add_published(v1::Grant* grant, Tick tick, const TopicTally& topic) {
  auto* published = grant->add_published();
  published->set_topic(topic.topic);
  published->set_tick(tick);
  published->set_messages(topic.messages);
  published->set_last_sequence(topic.last_sequence);
  published->set_digest(topic.digest);
  published->set_incarnation(topic.incarnation);
}

namespace {

void add_starts(v1::Topology* topology, const std::string& agent, const Coordinator& coordinator) {
  for (const auto& [name, member] : coordinator.behind()) {
    if (member.host != agent) continue;
    auto* start = topology->add_starts();
    start->set_name(name);
    start->set_resume_tick(member.resumes_at);
    start->set_from_tick(coordinator.publishes_from(member));
    start->set_incarnation(member.incarnation);
  }
}

}  // namespace

v1::Topology topology_for(const std::string& name, v1::Topology topology,
                          const Coordinator& coordinator) {
  const auto member = coordinator.members().find(name);
  if (member != coordinator.members().end()) {
    topology.set_resume_tick(member->second.resumes_at);
    topology.set_from_tick(coordinator.publishes_from(member->second));
    if (member->second.agent) add_starts(&topology, name, coordinator);
  }
  topology.set_running(coordinator.phase() == Phase::running);
  for (auto& publisher : *topology.mutable_publishers())
    publisher.set_keep_ticks(std::uint64_t(coordinator.keep_ticks(publisher.name())));
  return topology;
}

void describe(v1::Grant* grant, std::uint64_t run_id, const Coordinator& coordinator) {
  grant->Clear();
  grant->set_run_id(run_id);
  grant->set_tick(coordinator.granted());
  grant->set_phase(static_cast<v1::Phase>(coordinator.phase()));
  grant->set_cause(coordinator.cause());
  for (const auto& [name, member] : coordinator.members()) {
    if (!member.dropped) continue;
    for (const std::string& topic : member.node.produces) {
      auto* closed = grant->add_closed();
      closed->set_topic(topic);
      closed->set_from_tick(member.closed_from);
    }
  }
  if (coordinator.over())
    grant->set_deserted(std::ranges::none_of(coordinator.members(), [](const auto& entry) {
      return entry.second.keeps_time && entry.second.active();
    }));
}

void describe(v1::Endpoints* endpoints, const Coordinator& coordinator) {
  endpoints->set_phase(static_cast<v1::Phase>(coordinator.phase()));
  endpoints->set_cause(coordinator.cause());
  endpoints->set_granted_tick(coordinator.granted());
  endpoints->set_settled_tick(coordinator.settled());
  endpoints->set_last_tick(coordinator.options().last_tick);
  endpoints->set_paused(coordinator.paused());
  endpoints->set_pace(coordinator.pace().factor());
  endpoints->set_overruns(coordinator.pace().overruns());
  endpoints->set_worst_lag_s(to_seconds(coordinator.pace().worst_lag()));
  endpoints->set_digest(coordinator.digest());
  const auto add = [&](const std::string& name, const Coordinator::Member& member, bool heard) {
    auto* node = endpoints->add_nodes();
    node->set_name(name);
    node->set_done_tick(member.done);
    node->set_alive(member.active() && !member.silent && heard);
    node->set_incarnation(member.incarnation);
    node->set_observer(member.observer);
    node->mutable_consumes()->Add(member.node.consumes.begin(), member.node.consumes.end());
  };
  for (const auto& [name, member] : coordinator.members()) add(name, member, true);
  for (const auto& [name, member] : coordinator.behind()) {
    const auto agent = coordinator.members().find(member.host);
    add(name, member, agent != coordinator.members().end() && !agent->second.silent);
  }
  for (const std::string& name : coordinator.missing()) endpoints->add_missing(name);
  for (const std::string& name : coordinator.holding()) endpoints->add_holding(name);
}

std::string request_text(const v1::Control& control) {
  switch (control.action()) {
    case v1::Control::ACTION_PAUSE:
      return control.tick() > 0 ? fmt::format("pause after tick {}", control.tick()) : "pause";
    case v1::Control::ACTION_STEP:
      return control.tick() == 1 ? "step 1 tick" : fmt::format("step {} ticks", control.tick());
    case v1::Control::ACTION_GO_ON:
      return "go on";
    case v1::Control::ACTION_PACE:
      return control.factor() > 0.0
                 ? fmt::format("keep a pace of {:g} times real time", control.factor())
                 : "run as fast as possible";
    case v1::Control::ACTION_END_EARLY:
      return "end early";
    case v1::Control::ACTION_ABORT:
      return "abort";
    default:
      return "do nothing";
  }
}

void apply(const v1::Control& control, Coordinator& coordinator, Instant now) {
  const std::string why = control.reason().empty()
                              ? "ended on request"
                              : "ended on request: " + printable(control.reason());
  switch (control.action()) {
    case v1::Control::ACTION_PAUSE:
      return coordinator.pause(control.tick(), now);
    case v1::Control::ACTION_STEP:
      return coordinator.step(control.tick(), now);
    case v1::Control::ACTION_GO_ON:
      return coordinator.go_on(now);
    case v1::Control::ACTION_PACE:
      return coordinator.change_pace(control.factor(), now);
    case v1::Control::ACTION_END_EARLY:
      return coordinator.end_early(why);
    case v1::Control::ACTION_ABORT:
      return coordinator.fail_run(why);
    default:
      return;
  }
}

}  // namespace dmise
