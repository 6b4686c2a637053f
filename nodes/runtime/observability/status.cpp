#include "nodes/runtime/observability/status.h"

#include "core/base/error.h"
#include "core/base/printable.h"
#include "dmise/v1/time.pb.h"
#include "nodes/runtime/process/monotonic_clock.h"
#include "nodes/runtime/process/seconds.h"
#include "nodes/runtime/protocol/time_split_codec.h"
#include "nodes/runtime/transport/socket.h"

namespace dmise {
namespace {

static_assert(int(ClockAction::pause) == v1::Control::ACTION_PAUSE &&
              int(ClockAction::pace) == v1::Control::ACTION_PACE);

/// A phase that is not known here counts as the first.
Phase from_wire(v1::Phase phase) {
  return phase > v1::PHASE_GATHERING && phase <= v1::PHASE_FAILED ? static_cast<Phase>(phase)
                                                                  : Phase::gathering;
}

v1::NodeMessage hello() {
  v1::NodeMessage question;
  question.mutable_hello();
  return question;
}

/// A conversation with a time-master. Throws `Error` if there is no answer within the time.
class Conversation {
 public:
  Conversation(const std::string& address, double within_s, const Security& security)
      : address_(address),
        deadline_(now() + from_seconds(within_s)),
        socket_(make_socket(context_, zmq::socket_type::dealer, max_control_bytes)) {
    connect_to(socket_, address, security, master_name);
  }

  RunStatus ask(const v1::NodeMessage& question) {
    socket_.send(to_frame(question), zmq::send_flags::none);
    std::vector<zmq::pollitem_t> items{{socket_.handle(), 0, ZMQ_POLLIN, 0}};
    wait_for(items, deadline_ - now());
    const auto frame = receive_one(socket_);
    v1::MasterMessage answer;
    const bool understood = frame && from_frame(*frame, &answer);
    if (understood && answer.has_refuse())
      throw Error(address_ + ": " + printable(answer.refuse().reason()));
    if (!understood || !answer.has_endpoints())
      throw Error("no answer from a time-master at " + address_);
    return status_of(answer.endpoints());
  }

 private:
  std::string address_;
  std::chrono::nanoseconds deadline_;
  zmq::context_t context_{1};
  zmq::socket_t socket_;
};

}  // namespace

RunStatus status_of(const v1::Endpoints& e) {
  RunStatus status{.run_id = e.run_id(),
                   .phase = from_wire(e.phase()),
                   .cause = e.cause(),
                   .granted = e.granted_tick(),
                   .last_tick = e.last_tick(),
                   .tick_length = {e.tick_ns()},
                   .start_utc = e.start_utc(),
                   .scenario_digest = e.scenario_digest(),
                   .settled = e.settled_tick(),
                   .paused = e.paused(),
                   .pace = e.pace(),
                   .overruns = e.overruns(),
                   .worst_lag_s = e.worst_lag_s(),
                   .digest = e.digest(),
                   .broker = {e.broker().publish_endpoint(), e.broker().subscribe_endpoint(),
                              e.broker().observe_endpoint()},
                   .nodes = {},
                   .missing = {e.missing().begin(), e.missing().end()},
                   .holding = {e.holding().begin(), e.holding().end()}};
  for (const auto& node : e.nodes())
    status.nodes.push_back({.name = node.name(),
                            .done = node.done_tick(),
                            .alive = node.alive(),
                            .observer = node.observer(),
                            .incarnation = node.incarnation(),
                            .times = take(node.times()),
                            .consumes = {node.consumes().begin(), node.consumes().end()}});
  return status;
}

RunStatus ask_master(const std::string& address, double within_s, const Security& security) {
  return Conversation(address, within_s, security).ask(hello());
}

RunStatus control_master(const std::string& address, double within_s, const ClockRequest& request,
                         const Security& security) {
  Conversation conversation(address, within_s, security);
  v1::NodeMessage question;
  question.set_run_id(conversation.ask(hello()).run_id);
  auto* control = question.mutable_control();
  control->set_action(static_cast<v1::Control::Action>(request.action));
  control->set_tick(request.tick);
  control->set_factor(request.factor);
  control->set_reason(request.reason);
  return conversation.ask(question);
}

}  // namespace dmise
