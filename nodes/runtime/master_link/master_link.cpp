#include "nodes/runtime/master_link/master_link.h"

#include <spdlog/spdlog.h>

#include "core/base/error.h"
#include "nodes/runtime/process/monotonic_clock.h"
#include "nodes/runtime/protocol/control_rules.h"
#include "nodes/runtime/protocol/time_split_codec.h"

namespace dmise {

using std::chrono::nanoseconds;

MasterLink::MasterLink(zmq::context_t& context, std::string master, const Event* stop,
                       const Security& security)
    : context_(context),
      master_(std::move(master)),
      security_(security),
      stop_(stop),
      control_(make_socket(context, zmq::socket_type::dealer, max_control_bytes)),
      ticks_(make_socket(context, zmq::socket_type::sub, max_control_bytes)) {
  control_.set(zmq::sockopt::linger, 1000);  // for the last messages
  connect_to(control_, master_, security_, master_name);
}

MasterLink::~MasterLink() = default;

v1::Welcome MasterLink::join(const v1::Join& request, nanoseconds within) {
  name_ = request.name();
  v1::NodeMessage message;
  *message.mutable_join() = request;
  send(std::move(message));
  const auto deadline = now() + within;
  while (!answer_ && now() < deadline && !stopped()) wait({}, deadline - now());
  if (stopped()) throw Error("interrupted");
  if (!answer_) {
    control_.set(zmq::sockopt::linger, 0);
    throw Error("no answer from a time-master at " + master_);
  }
  if (answer_->has_refuse())
    throw Error("refused by the time-master at " + master_ + ": " + answer_->refuse().reason());
  welcome_ = answer_->welcome();
  ticks_.set(zmq::sockopt::subscribe, "");
  connect_to(ticks_, welcome_.tick_endpoint(), security_, master_name);
  return welcome_;
}

void MasterLink::keep(HeartbeatOptions options, std::optional<zmq::socket_t> resend_socket) {
  options.master = master_;
  options.security = security_;
  options.welcome = welcome_;
  options.welcome.set_name(name_);
  options.stop = stop_;
  heartbeat_ =
      std::make_unique<HeartbeatThread>(context_, std::move(options), std::move(resend_socket));
}

void MasterLink::ready() {
  v1::NodeMessage message;
  message.mutable_ready();
  send(std::move(message));
}

void MasterLink::done(const TickTally& tally) {
  v1::NodeMessage message;
  auto* done = message.mutable_done();
  done->set_tick(tally.tick);
  done->set_digest(tally.digest);
  for (const TopicTally& topic : tally.topics) {
    auto* published = done->add_published();
    published->set_topic(topic.topic);
    published->set_messages(topic.messages);
    published->set_last_sequence(topic.last_sequence);
    published->set_digest(topic.digest);
    published->set_incarnation(topic.incarnation);
  }
  send(std::move(message));
}

void MasterLink::leave(bool interrupted, const TimeSplit& times) {
  v1::NodeMessage message;
  auto* leave = message.mutable_leave();
  leave->set_interrupted(interrupted);
  put(leave->mutable_times(), times);
  put(leave->mutable_times(), process_memory());
  send(std::move(message));
}

void MasterLink::failed(const std::string& reason) {
  v1::NodeMessage message;
  message.mutable_failed()->set_reason(reason);
  send(std::move(message));
}

void MasterLink::send(v1::NodeMessage message) {
  message.set_run_id(welcome_.run_id());
  control_.send(to_frame(message), zmq::send_flags::none);
}

void MasterLink::wait(const std::vector<zmq::socket_t*>& sockets, nanoseconds at_most) {
  items_.clear();
  items_.push_back({ticks_.handle(), 0, ZMQ_POLLIN, 0});
  items_.push_back({control_.handle(), 0, ZMQ_POLLIN, 0});
  for (zmq::socket_t* socket : sockets) items_.push_back({socket->handle(), 0, ZMQ_POLLIN, 0});
  if (stop_) items_.push_back({nullptr, stop_->fd(), ZMQ_POLLIN, 0});
  if (heartbeat_) items_.push_back({nullptr, heartbeat_->news().fd(), ZMQ_POLLIN, 0});
  wait_for(items_, at_most);
  if (items_[0].revents) handle_ticks();
  if (items_[1].revents) handle_control();
  if (heartbeat_ && items_.back().revents) take(heartbeat_->latest());
}

void MasterLink::handle_ticks() {
  while (const auto frame = receive_one(ticks_)) {
    if (!from_frame(*frame, &scratch_) || scratch_.run_id() != welcome_.run_id() ||
        fault_of(scratch_))
      continue;
    receives_ticks_ = true;
    take(scratch_);
  }
}

void MasterLink::handle_control() {
  while (const auto frame = receive_one(control_)) {
    v1::MasterMessage message;
    if (!from_frame(*frame, &message)) continue;
    if (const auto fault = fault_of(message)) {
      spdlog::warn("refused a message of the time-master: {}", *fault);
      continue;
    }
    if (message.has_welcome() || message.has_refuse()) {
      const std::string& name =
          message.has_welcome() ? message.welcome().name() : message.refuse().name();
      if (!answer_ || name == name_)
        answer_ = message;
      else
        answers_.push_back(std::move(message));
    } else if (message.has_topology()) {
      topology_ = message.topology();
      ++topology_version_;
    } else if (message.has_grant() && message.grant().run_id() == welcome_.run_id()) {
      take(message.grant());
    }
  }
}

void MasterLink::take(const v1::Grant& grant) {
  granted_ = std::max<Tick>(granted_, grant.tick());
  deserted_ = deserted_ || grant.deserted();
  if (!over() && phase_ != grant.phase()) {  // ignore an outdated grant
    const bool later = int(grant.phase()) > int(phase_);
    if (later) phase_ = grant.phase();
    if (phase_ == v1::PHASE_FAILED) cause_ = grant.cause();
  }
  published_.insert(published_.end(), grant.published().begin(), grant.published().end());
  if (std::size_t(grant.closed_size()) > closed_.size())
    closed_.assign(grant.closed().begin(), grant.closed().end());
}

}  // namespace dmise
