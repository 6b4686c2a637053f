#include "nodes/runtime/master_link/heartbeat_thread.h"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "core/sim/message.h"
#include "dmise/v1/node.pb.h"
#include "nodes/runtime/process/monotonic_clock.h"
#include "nodes/runtime/process/process_memory.h"
#include "nodes/runtime/protocol/control_rules.h"
#include "nodes/runtime/protocol/time_split_codec.h"

namespace dmise {
namespace {

/// Between checks of connections, while there are any.
constexpr std::chrono::milliseconds look_interval{50};
constexpr int questions_at_once = 64;
constexpr std::chrono::seconds gone_after{5};  // for a time-master that is silent after the end

}  // namespace

HeartbeatThread::HeartbeatThread(zmq::context_t& context, HeartbeatOptions options,
                                 std::optional<zmq::socket_t> resend_socket)
    : options_(std::move(options)),
      heartbeat_(make_socket(context, zmq::socket_type::dealer, max_control_bytes)),
      resend_(std::move(resend_socket)),
      heard_(now()) {
  if (resend_) askers_.emplace(context, *resend_, bytes_alone(max_unheard_questions_bytes));
  connect_to(heartbeat_, options_.master, options_.security, master_name);
  thread_ = std::thread([this] { run(); });
}

HeartbeatThread::~HeartbeatThread() {
  quit_.set();
  thread_.join();
}

v1::Grant HeartbeatThread::latest() {
  const std::lock_guard lock(mutex_);
  news_.clear();
  return latest_;
}

void HeartbeatThread::set_times(const TimeSplit& times) {
  const std::lock_guard lock(mutex_);
  times_ = times;
}

void HeartbeatThread::run() {
  auto next_beat = now();
  auto awake = now();
  auto next_look = now();
  while (!quit_.is_set()) {
    if (now() >= next_beat) {
      beat();
      next_beat = now() + from_seconds(options_.welcome.heartbeat_s());
    }
    std::vector<zmq::pollitem_t> items{{nullptr, quit_.fd(), ZMQ_POLLIN, 0},
                                       {heartbeat_.handle(), 0, ZMQ_POLLIN, 0}};
    if (resend_) items.push_back({resend_->handle(), 0, ZMQ_POLLIN, 0});
    if (askers_) items.push_back({askers_->handle(), 0, ZMQ_POLLIN, 0});
    // A message without an end does not end the wait.
    wait_for(items,
             (askers_ && askers_->size() > 0 ? std::min(next_beat, next_look) : next_beat) - now());
    // While this process was suspended it could not receive anything.
    if (now() - awake > silent_after() / 2) heard_ = now();
    awake = now();
    handle_replies();
    if (resend_) answer();
    if (askers_ && (items.back().revents || now() >= next_look)) {
      for (const std::string& closed : askers_->enforce(now())) spdlog::warn("{}", closed);
      askers_->forget(askers_->broken());
      next_look = now() + look_interval;
    }
    leave_if_stuck();
  }
}

void HeartbeatThread::beat() {
  v1::NodeMessage message;
  message.set_run_id(options_.welcome.run_id());
  auto* heartbeat = message.mutable_heartbeat();
  heartbeat->set_name(options_.welcome.name());
  heartbeat->set_incarnation(options_.welcome.incarnation());
  heartbeat->set_token(options_.welcome.heartbeat_token());
  heartbeat->set_computing(computing_.load(std::memory_order_relaxed));
  heartbeat->set_progress(options_.progress ? options_.progress() : 0);
  {
    const std::lock_guard lock(mutex_);
    put(heartbeat->mutable_times(), times_);
  }
  put(heartbeat->mutable_times(), process_memory());
  if (options_.add_to_heartbeat) options_.add_to_heartbeat(heartbeat);
  heartbeat_.send(to_frame(message), zmq::send_flags::none);
}

void HeartbeatThread::handle_replies() {
  while (const auto frame = receive_one(heartbeat_)) {
    v1::MasterMessage message;
    if (!from_frame(*frame, &message) || message.grant().run_id() != options_.welcome.run_id() ||
        fault_of(message))
      continue;
    heard_ = now();
    post(message.grant());
  }
  const auto silence = now() - heard_;
  if (!over_ && silence > silent_after()) {
    v1::Grant lost;
    lost.set_run_id(options_.welcome.run_id());
    lost.set_phase(v1::PHASE_FAILED);
    lost.set_cause(fmt::format("the time-master at {} has been silent for {:.1f} s",
                               options_.master, to_seconds(silence)));
    post(lost);
  } else if (over_ && !gone_ && silence > gone_after) {
    v1::Grant alone;  // its last words were lost
    alone.set_run_id(options_.welcome.run_id());
    alone.set_deserted(true);
    post(alone);
    gone_ = true;
  }
}

void HeartbeatThread::post(const v1::Grant& grant) {
  over_ = over_ || grant.phase() == v1::PHASE_ENDED || grant.phase() == v1::PHASE_FAILED;
  const std::lock_guard lock(mutex_);
  latest_ = grant;
  news_.set();
}

void HeartbeatThread::answer() {
  // Repeated questions that wait together are answered once, with the latest content. The heartbeat
  // never waits for more than a few questions.
  std::map<std::tuple<std::string, std::string, bool>, v1::ResendRequest> questions;
  for (int i = 0; i < questions_at_once; ++i) {
    auto message = receive(*resend_);
    if (message.empty()) break;
    for (std::size_t i = 1; i < message.size(); ++i) askers_->count_read(message[i]);
    v1::ResendRequest request;
    if (message.size() != 2 || !from_frame(message[1], &request) ||
        request.run_id() != options_.welcome.run_id() || fault_of(request))
      continue;
    if (options_.security.on() && request.topic().starts_with(truth_prefix) &&
        !may_receive_truth(message[1]))
      continue;
    questions[{message[0].to_string(), request.topic(), request.catch_up()}] = request;
  }
  for (const auto& [question, request] : questions)
    for (const SharedFrames& frames : options_.resend(request))
      send(*resend_, frames, std::get<0>(question));
}

void HeartbeatThread::leave_if_stuck() {
  if (options_.stop_within.count() == 0) return;
  if (!over_since_ && (over_ || (options_.stop && options_.stop->is_set()))) over_since_ = now();
  if (!over_since_ || !computing_.load(std::memory_order_relaxed)) return;
  if (now() - *over_since_ < options_.stop_within) return;
  spdlog::error("{}: stopping in the middle of a step", options_.welcome.name());
  _exit(1);
}

}  // namespace dmise
