// Control messages of nodes, agents and observers, and what the time-master answers.
#include <spdlog/spdlog.h>

#include <utility>

#include "core/base/printable.h"
#include "nodes/runtime/process/json_log.h"
#include "nodes/runtime/process/monotonic_clock.h"
#include "nodes/runtime/protocol/control_rules.h"
#include "nodes/runtime/protocol/time_split_codec.h"
#include "nodes/runtime/transport/own_name.h"
#include "time-master/master_messages.h"
#include "time-master/master_process.h"

namespace dmise {
namespace {

constexpr std::size_t max_unasked_bytes = 4096;       // messages of a guest
constexpr std::size_t max_observed_bytes = 64 << 10;  // topics of one observer

}  // namespace

bool MasterProcess::is_timekeeper(const std::string& name) const {
  if (name.empty()) return false;
  const auto member = coordinator_.members().find(name);
  return member != coordinator_.members().end() && !member->second.is_guest();
}

bool MasterProcess::handle_member(ControlMessage& message) {
  const std::string& name = directory_.name_of(message.from());
  const bool clock = is_timekeeper(name) || is_timekeeper(connections_.name_of(message.body));
  if (!clock && (name.empty() || expects_reply(message.body))) return false;
  if (clock && !ended_) ++messages_;
  handle(message, name);
  return true;
}

bool MasterProcess::expects_reply(const zmq::message_t& body) {
  if (body.size() > max_unasked_bytes || !from_frame(body, &heard_)) return true;
  return !heard_.has_done() && !heard_.has_ready() && !heard_.has_leave() && !heard_.has_failed();
}

void MasterProcess::handle_stranger(ControlMessage& message) {
  if (PeerMonitor::is_stuck(message.body)) return;  // it does not read replies
  handle(message, directory_.name_of(message.from()));
  // A message of many small parts leaves a large allocation behind.
  if (message.body.size() > (16 << 10)) heard_ = v1::NodeMessage();
}

void MasterProcess::handle(ControlMessage& message, const std::string& name) {
  if (!from_frame(message.body, &heard_)) return;
  const bool before_welcome = (heard_.has_hello() || heard_.has_join()) && heard_.run_id() == 0;
  if (!before_welcome && heard_.run_id() != run_id_) return;
  const std::string_view sender = message.from();
  auto fault = fault_of(heard_);
  if (!fault && security_.on()) fault = fault_of_sender(heard_, message.body, name);
  if (fault) return refuse(sender, *fault);
  if (heard_.has_done()) {
    done(name);
  } else if (heard_.has_heartbeat()) {
    heartbeat(sender, message.body);
  } else if (heard_.has_join()) {
    join(sender, message.body);
  } else if (heard_.has_ready()) {
    coordinator_.ready(name, now());
  } else if (heard_.has_leave()) {
    leave(name);
  } else if (heard_.has_node_news()) {
    handle_news(name);
  } else if (heard_.has_failed()) {
    coordinator_.fail(name, printable(heard_.failed().reason()));
  } else if (heard_.has_hello() || heard_.has_control()) {
    if (heard_.has_control()) control();
    if (heard_.has_hello() && !before_welcome) adopt(sender);
    v1::MasterMessage answer;
    fill(answer.mutable_endpoints());
    publisher_.reply(sender, answer);
  }
  drop_removed();
}

void MasterProcess::drop_removed() {
  for (const std::string& name : coordinator_.take_forgotten()) {
    directory_.remove(name);
    owners_.remove(name);
    times_.erase(name);
  }
}

void MasterProcess::refuse(std::string_view sender, const std::string& fault) {
  log_.warn("messages refused", "refused a message: " + fault);
  if (heard_.has_join()) refuse_join(sender, fault, printable(heard_.join().name(), 256));
}

void MasterProcess::refuse_join(std::string_view sender, const std::string& reason,
                                const std::string& name) {
  if (refusals_.take(sender, now())) publisher_.refuse(sender, reason, name);
}

void MasterProcess::done(const std::string& name) {
  if (security_.on() && !owners_.keep_own(name, heard_.mutable_done()))
    log_.warn("messages refused", "refused what " + name + " reports about topics of others");
  if (tick_log_.is_wait_due(now())) tick_log_.wait(coordinator_.holding(), now());
  coordinator_.done(name, tally_of(heard_.done()), now());
  tick_log_.settle(coordinator_.settled(), now(), name);
  if (heard_.done().published().empty()) return;
  const auto member = coordinator_.members().find(name);
  if (member == coordinator_.members().end() || member->second.is_guest()) return;
  TickTally tally = tally_of(heard_.done());
  if (!member->second.agent)
    for (TopicTally& topic : tally.topics) topic.incarnation = member->second.incarnation;
  publisher_.note(tally);
}

void MasterProcess::control() {
  if (log_.admits("control requests")) spdlog::info("asked to {}", request_text(heard_.control()));
  apply(heard_.control(), coordinator_, now());
}

void MasterProcess::join(std::string_view sender, zmq::message_t& frame) {
  const v1::Join& join = heard_.join();
  const Coordinator::Request request = request_of(join);
  const bool is_broker = join.name() == broker_name;
  const std::string& stands_for = directory_.name_of(sender);
  suspect(connections_.names_of(broken_));  // whose last messages may just have been handled
  std::optional<std::string> refusal;
  if (join.has_broker() != is_broker)
    refusal = "only the broker is named broker";
  else if (!join.host().empty() && stands_for != join.host())
    refusal = "only " + join.host() + " speaks for the nodes of its host";
  else if (join.host().empty() && !stands_for.empty() && stands_for != join.name())
    refusal = "this connection is that of " + stands_for;
  else if (join.observer() && join.ByteSizeLong() > max_observed_bytes)
    refusal = "an observer's topics may have 64 KiB in all";
  else if (has_joined(join, stands_for))
    return publisher_.reply(sender,
                            publisher_.welcome(join.name(), tick_endpoint_,
                                               directory_.all().at(join.name()).heartbeat_token));
  else if (auto fault = join.observer() ? std::nullopt : owners_.fault_of(join))
    refusal = std::move(fault);
  else
    refusal = coordinator_.join(request, now());
  if (refusal) {
    refuse_join(sender, *refusal, join.name());
    if (log_.admits("nodes refused"))
      log_event(spdlog::level::warn, "node_refused", {{"name", join.name()}, {"reason", *refusal}},
                "refused " + join.name() + ": " + *refusal);
    return;
  }
  drop_removed();
  owners_.add(join);
  const std::uint64_t token = random_number();
  const std::uint64_t incarnation = coordinator_.member_of(join.name()).incarnation;
  if (join.host().empty()) {
    directory_.add(sender, incarnation, join, token);
    connections_.identify(frame, join.name(), join.observer());
  } else {
    directory_.add_behind(sender, incarnation, join, token);
  }
  publisher_.reply(sender, publisher_.welcome(join.name(), tick_endpoint_, token));
  if (join.observer() && coordinator_.phase() != Phase::gathering)
    publisher_.announce_observer(join.name());
  if (join.observer() && !log_.admits("observers joined")) return;
  const auto missing = coordinator_.missing();
  log_event(
      spdlog::level::info, "node_joined",
      {{"name", join.name()}, {"incarnation", incarnation}, {"missing", joined(missing)}},
      fmt::format("{} joined{}{}", join.name(),
                  incarnation == 1 ? "" : fmt::format(", process {} of its name", incarnation),
                  missing.empty() ? "" : "; waiting for " + joined(missing)));
}

bool MasterProcess::has_joined(const v1::Join& join, const std::string& stands_for) const {
  const auto peer = directory_.all().find(join.name());
  return coordinator_.phase() == Phase::gathering && peer != directory_.all().end() &&
         stands_for == (join.host().empty() ? join.name() : join.host()) &&
         peer->second.join.SerializeAsString() == join.SerializeAsString();
}

void MasterProcess::adopt(std::string_view sender) {
  const std::string name = directory_.adopt(sender);
  if (name.empty()) return;
  if (log_.admits("connections replaced"))
    log_event(spdlog::level::warn, "node_connected_again", {{"name", name}},
              name + " has connected again");
  publisher_.send_again(name);
}

void MasterProcess::heartbeat(std::string_view sender, zmq::message_t& frame) {
  const auto& heartbeat = heard_.heartbeat();
  const auto member = coordinator_.members().find(heartbeat.name());
  const Peer* peer = directory_.find(heartbeat.name(), heartbeat.incarnation());
  if (!peer)
    return publisher_.reply(
        sender, publisher_.expelled(directory_.knows(heartbeat.name())
                                        ? "another process has taken the name " + heartbeat.name()
                                        : "the run goes on without " + heartbeat.name()));
  // A key proves as much as the token does.
  const bool own = security_.on() || heartbeat.token() == peer->heartbeat_token;
  if (!peer->join.host().empty() || !own)
    return log_.warn("messages refused",
                     "refused a heartbeat under the name of " + heartbeat.name());
  connections_.identify(frame, heartbeat.name(), peer->join.observer());
  directory_.prove(heartbeat.name(), sender);
  coordinator_.heartbeat(heartbeat.name(), heartbeat.computing(), heartbeat.progress(), now());
  times_[heartbeat.name()] = take(heartbeat.times());
  handle_host_report(heartbeat.name(), heartbeat.nodes(),
                     {heartbeat.holding().begin(), heartbeat.holding().end()});
  if (member == coordinator_.members().end() || member->second.dropped)
    return publisher_.reply(sender,
                            publisher_.expelled("the run goes on without " + heartbeat.name()));
  if (answers_.take(heartbeat.name(), now()) && !PeerMonitor::is_stuck(frame))
    publisher_.reply(sender, publisher_.grant_for(member->second));
}

void MasterProcess::leave(const std::string& name) {
  const auto& leave = heard_.leave();
  if (name.empty()) return;
  times_[name] = take(leave.times());
  handle_host_report(name, leave.nodes(), {});
  coordinator_.leave(name, leave.interrupted(), now(), leave.cause());
  spdlog::debug("{} left", name);
}

void MasterProcess::handle_host_report(const std::string& agent, const NodeBeats& nodes,
                                       std::vector<std::string> holding) {
  if (nodes.empty()) return;
  std::map<std::string, Tick> done;
  for (const v1::NodeBeat& node : nodes) {
    const auto known = coordinator_.behind().find(node.name());
    if (known == coordinator_.behind().end() || known->second.host != agent) continue;
    done[node.name()] = node.done_tick();
    times_[node.name()] = take(node.times());
  }
  coordinator_.report_behind(agent, std::move(holding), done);
}

void MasterProcess::handle_news(const std::string& agent) {
  const v1::NodeNews& news = heard_.node_news();
  const auto node = coordinator_.behind().find(news.name());
  if (node == coordinator_.behind().end() || node->second.host != agent) return;
  switch (news.what()) {
    case v1::NodeNews::WHAT_LOST:
      return coordinator_.lost_behind(news.name(), news.incarnation(), printable(news.reason()),
                                      news.done_tick(), now());
    case v1::NodeNews::WHAT_FOUND:
      return coordinator_.found_behind(news.name(), news.incarnation());
    case v1::NodeNews::WHAT_FAILED:
      return coordinator_.fail_behind(news.name(), news.incarnation(), printable(news.reason()));
    default:
      return;
  }
}

}  // namespace dmise
