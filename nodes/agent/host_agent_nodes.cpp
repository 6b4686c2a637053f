// The nodes of a host: their messages, and what the run answers to them.
#include <spdlog/spdlog.h>

#include "core/base/printable.h"
#include "nodes/agent/host_agent_process.h"
#include "nodes/runtime/process/monotonic_clock.h"
#include "nodes/runtime/protocol/control_rules.h"
#include "nodes/runtime/transport/own_name.h"
#include "time-master/master_messages.h"

namespace dmise {

void HostAgentProcess::handle_nodes() {
  for (auto message = receive(router_); !message.empty(); message = receive(router_)) {
    for (std::size_t i = 1; i < message.size(); ++i) connections_.count_read(message[i]);
    if (message.size() != 2 || !from_frame(message[1], &heard_)) continue;
    const std::string_view sender = message[0].to_string_view();
    auto fault = fault_of(heard_);
    if (!fault && security_.on())
      fault = fault_of_sender(heard_, message[1], directory_.name_of(sender));
    if (fault) {
      spdlog::warn("refused a message: {}", *fault);
      if (heard_.has_join()) publisher_.refuse(sender, *fault);
      continue;
    }
    if (heard_.has_join()) {
      join_of(sender, message[1]);
      continue;
    }
    if (heard_.run_id() != link_.welcome().run_id()) continue;
    if (heard_.has_hello()) {
      adopt(sender);
      continue;
    }
    const std::string name = directory_.name_of(sender);
    if (heard_.has_heartbeat())
      heartbeat(sender, message[1]);
    else if (name.empty())
      continue;
    else if (heard_.has_done())
      done(name);
    else if (heard_.has_ready())
      barrier_->ready(name, now());
    else if (heard_.has_leave())
      leave_of(name);
    else if (heard_.has_failed())
      barrier_->fail(name, printable(heard_.failed().reason()));
  }
}

void HostAgentProcess::join_of(std::string_view sender, zmq::message_t& frame) {
  const v1::Join& join = heard_.join();
  if (over()) return publisher_.refuse(sender, "the run is over");
  if (join.observer() || join.has_broker() || join.agent() || !join.host().empty())
    return publisher_.refuse(
        sender, "only nodes that keep time join an agent; join " + options_.master + " itself");
  suspect(connections_.names_of(broken_));  // whose last messages may just have been handled
  const auto asked = joining_.find(join.name());
  if (asked != joining_.end() &&
      asked->second.join.SerializeAsString() == join.SerializeAsString()) {
    asked->second.routing_id = sender;  // its connection broke before the answer
    connections_.identify(frame, join.name());
    return;
  }
  if (barrier_->has_live_process(join.name()))
    return publisher_.refuse(sender, "a node named " + join.name() + " has already joined");
  barrier_->give_up(join.name());
  send_news();  // first: the master must know that the name is free
  joining_[join.name()] = {std::string(sender), 0, join, 0, {}};
  connections_.identify(frame, join.name());
  barrier_->begin_join(join.name());
  forward(join);
}

void HostAgentProcess::forward(const v1::Join& join) {
  v1::NodeMessage message;
  *message.mutable_join() = join;
  message.mutable_join()->set_host(options_.name);
  link_.send(std::move(message));
}

/// A node whose connection broke continues over another, over which it has proved itself.
void HostAgentProcess::adopt(std::string_view sender) {
  const std::string name = directory_.adopt(sender);
  if (name.empty()) return;
  spdlog::warn("{} has connected again", name);
  if (topology_version_ > 0) send_topology(name);
  publisher_.reply(sender, publisher_.grant_for(directory_.all().at(name).join));
  v1::MasterMessage known;
  known.mutable_endpoints()->set_run_id(link_.welcome().run_id());
  publisher_.reply(sender, known);
}

void HostAgentProcess::done(const std::string& name) {
  if (security_.on() && !owners_.keep_own(name, heard_.mutable_done()))
    spdlog::warn("refused what {} reports about topics of others", name);
  barrier_->done(name, tally_of(heard_.done()), now());
  const Peer& peer = directory_.all().at(name);
  for (v1::TopicTally tally : heard_.done().published()) {
    tally.set_tick(heard_.done().tick());
    tally.set_incarnation(peer.incarnation);
    publisher_.note(tally);
  }
}

void HostAgentProcess::heartbeat(std::string_view sender, zmq::message_t& frame) {
  const auto& heartbeat = heard_.heartbeat();
  const std::string& name = heartbeat.name();
  const Peer* peer = directory_.find(name, heartbeat.incarnation());
  if (!peer) {
    return publisher_.reply(
        sender, publisher_.expelled(directory_.knows(name)
                                        ? "another process has taken the name " + name
                                        : "the agent " + options_.name + " that " + name +
                                              " joined is gone; another has taken its place"));
  }
  if (!security_.on() && heartbeat.token() != peer->heartbeat_token) return;  // another's
  if (!barrier_->nodes().contains(name))
    return publisher_.reply(sender, publisher_.expelled("the run goes on without " + name));
  connections_.identify(frame, name);
  directory_.prove(name, sender);
  barrier_->heartbeat(name, heartbeat.computing(), heartbeat.progress(), now());
  times_[name] = heartbeat.times();
  publisher_.reply(sender, publisher_.grant_for(peer->join));
}

void HostAgentProcess::leave_of(const std::string& name) {
  times_[name] = heard_.leave().times();
  barrier_->leave(name, heard_.leave().interrupted());
}

void HostAgentProcess::welcome(v1::MasterMessage answer) {
  const std::string name = answer.has_welcome() ? answer.welcome().name() : answer.refuse().name();
  const auto entry = joining_.find(name);
  if (entry == joining_.end()) return;
  const Peer peer = entry->second;
  joining_.erase(entry);
  if (answer.has_welcome()) {
    auto* welcome = answer.mutable_welcome();
    directory_.add(peer.routing_id, welcome->incarnation(), peer.join, welcome->heartbeat_token());
    owners_.add(peer.join);
    barrier_->join(name, request_of(peer.join).node.schedule, welcome->incarnation(),
                   welcome->resume_tick(), now());
    welcome->set_tick_endpoint(tick_endpoint_);
    said_ready_ = false;
    link_.not_ready();
    spdlog::info("{} joined{}", name,
                 welcome->incarnation() == 1
                     ? ""
                     : fmt::format(", process {} of its name", welcome->incarnation()));
  } else {
    barrier_->refused(name);
  }
  publisher_.reply(peer.routing_id, answer);
}

}  // namespace dmise
