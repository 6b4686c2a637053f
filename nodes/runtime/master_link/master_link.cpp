#include "nodes/runtime/master_link/master_link.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <utility>

#include "core/base/error.h"
#include "nodes/runtime/process/monotonic_clock.h"
#include "nodes/runtime/process/process_memory.h"
#include "nodes/runtime/protocol/control_rules.h"
#include "nodes/runtime/protocol/time_split_codec.h"

namespace dmise {

using std::chrono::nanoseconds;

namespace {

constexpr std::chrono::milliseconds between_proofs{500};
// Each look for a broken connection costs system calls, which at thousands of ticks a second count.
constexpr std::chrono::milliseconds between_looks{250};
constexpr std::chrono::milliseconds last_words{300};  // longest wait to be known again, to leave

/// A socket with an event for each connection of `watched` that is made and each that breaks.
zmq::socket_t breaks_of(zmq::context_t& context, zmq::socket_t& watched) {
  static std::atomic<int> count{0};
  const std::string address = "inproc://breaks-" + std::to_string(count++);
  if (zmq_socket_monitor(watched.handle(), address.c_str(),
                         ZMQ_EVENT_HANDSHAKE_SUCCEEDED | ZMQ_EVENT_DISCONNECTED) != 0)
    throw Error("can't watch the connection to the time-master");
  zmq::socket_t events = make_socket(context, zmq::socket_type::pair, max_control_bytes);
  events.connect(address);
  return events;
}

}  // namespace

MasterLink::MasterLink(zmq::context_t& context, std::string master, const Event* stop,
                       const Security& security)
    : context_(context),
      master_(std::move(master)),
      security_(security),
      stop_(stop),
      control_(make_socket(context, zmq::socket_type::dealer, max_control_bytes)),
      breaks_(breaks_of(context, control_)),
      ticks_(make_socket(context, zmq::socket_type::sub, max_control_bytes)) {
  control_.set(zmq::sockopt::linger, 1000);  // for the last messages
  // A connection that a firewall has forgotten breaks only when somebody finds out.
  control_.set(zmq::sockopt::heartbeat_ivl, 5000);
  control_.set(zmq::sockopt::heartbeat_timeout, 10000);
  connect_to(control_, master_, security_, master_name);
}

MasterLink::~MasterLink() = default;

v1::Welcome MasterLink::join(const v1::Join& request, nanoseconds within) {
  name_ = request.name();
  request_ = request;
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
  notice_breaks();
  ready_ = true;
  if (prove_at_) return;
  v1::NodeMessage message;
  message.mutable_ready();
  post(std::move(message));
}

namespace {

v1::NodeMessage done_message(const TickTally& tally) {
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
  return message;
}

}  // namespace

void MasterLink::done(const TickTally& tally) {
  while (!done_.empty() && done_.back().tick >= tally.tick) done_.pop_back();  // it is repeated
  done_.push_back(tally);
  while (!done_.empty() && done_.front().tick <= granted_ - Tick(welcome_.window_ticks()))
    done_.pop_front();
  if (!prove_at_) post(done_message(tally));
}

void MasterLink::leave(bool interrupted, const TimeSplit& times) {
  await_return();
  v1::NodeMessage message;
  auto* leave = message.mutable_leave();
  leave->set_interrupted(interrupted);
  if (phase() == v1::PHASE_FAILED) leave->set_cause(cause());
  put(leave->mutable_times(), times);
  put(leave->mutable_times(), process_memory());
  send(std::move(message));
}

void MasterLink::failed(const std::string& reason) {
  await_return();
  v1::NodeMessage message;
  message.mutable_failed()->set_reason(reason);
  send(std::move(message));
}

void MasterLink::send(v1::NodeMessage message) {
  notice_breaks();
  if (prove_at_)
    held_.push_back(std::move(message));
  else
    post(std::move(message));
}

void MasterLink::post(v1::NodeMessage message) {
  message.set_run_id(welcome_.run_id());
  control_.send(to_frame(message), zmq::send_flags::none);
}

void MasterLink::notice_breaks() {
  look_at_ = now() + between_looks;
  bool broken = false;
  for (auto event = receive(breaks_); !event.empty(); event = receive(breaks_)) {
    std::uint16_t what = 0;  // the first bytes, in the order of this machine
    if (event[0].size() >= sizeof what) std::memcpy(&what, event[0].data(), sizeof what);
    if (what == ZMQ_EVENT_HANDSHAKE_SUCCEEDED)
      connected_ = true;
    else if (std::exchange(connected_, false))  // what was sent over no connection waits for one
      broken = true;
  }
  if (broken) {  // what came over the old connection answers no question asked over the next
    prove_at_.reset();
    handle_control();
  }
  if (welcome_.run_id() != 0) {
    if (broken || (prove_at_ && now() >= *prove_at_)) prove();
  } else if (broken && !answer_) {
    v1::NodeMessage again;
    *again.mutable_join() = request_;
    post(std::move(again));
  }
}

/// Over the connection that follows the broken one: a heartbeat, which has the token, and `hello`
/// with the number of the run, which asks to take this connection for the process's own.
void MasterLink::prove() {
  v1::NodeMessage proof, hello;
  auto* heartbeat = proof.mutable_heartbeat();
  heartbeat->set_name(name_);
  heartbeat->set_incarnation(welcome_.incarnation());
  heartbeat->set_token(welcome_.heartbeat_token());
  put(heartbeat->mutable_times(), times_);
  put(heartbeat->mutable_times(), process_memory());
  hello.mutable_hello();
  post(std::move(proof));
  post(std::move(hello));
  prove_at_ = now() + between_proofs;
}

/// The master knows this process again.
void MasterLink::go_on() {
  prove_at_.reset();
  spdlog::warn("the connection to the time-master broke; it is replaced");
  if (ready_) ready();
  for (const TickTally& tally : done_) post(done_message(tally));
  if (repeat_) repeat_();
  for (v1::NodeMessage& message : std::exchange(held_, {})) post(std::move(message));
}

/// Before the last words.
void MasterLink::await_return() {
  notice_breaks();
  const auto deadline = now() + last_words;
  while (prove_at_ && now() < deadline) wait({}, deadline - now());
  prove_at_.reset();
  for (v1::NodeMessage& message : std::exchange(held_, {})) post(std::move(message));
}

void MasterLink::wait(const std::vector<zmq::socket_t*>& sockets, nanoseconds at_most) {
  items_.clear();
  items_.push_back({ticks_.handle(), 0, ZMQ_POLLIN, 0});
  items_.push_back({control_.handle(), 0, ZMQ_POLLIN, 0});
  for (zmq::socket_t* socket : sockets) items_.push_back({socket->handle(), 0, ZMQ_POLLIN, 0});
  if (stop_ && !prove_at_) items_.push_back({nullptr, stop_->fd(), ZMQ_POLLIN, 0});
  if (heartbeat_) items_.push_back({nullptr, heartbeat_->news().fd(), ZMQ_POLLIN, 0});
  if (prove_at_) at_most = std::min(at_most, *prove_at_ - now());
  wait_for(items_, std::min(at_most, nanoseconds(between_looks)));
  if (prove_at_ || now() >= look_at_) notice_breaks();
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
      if (!answer_)
        answer_ = message;
      else if (name != name_)
        answers_.push_back(std::move(message));
    } else if (message.has_topology()) {
      topology_ = message.topology();
      ++topology_version_;
    } else if (message.has_endpoints()) {
      if (prove_at_ && message.endpoints().run_id() == welcome_.run_id()) go_on();
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
