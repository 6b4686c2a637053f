#pragma once
#include <chrono>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

#include "dmise/v1/node.pb.h"
#include "dmise/v1/time.pb.h"
#include "nodes/runtime/process/event.h"
#include "nodes/runtime/protocol/outbox.h"
#include "nodes/runtime/protocol/time_split.h"
#include "nodes/runtime/transport/peer_monitor.h"
#include "nodes/runtime/transport/socket.h"

namespace dmise {

struct HeartbeatOptions {
  std::string master;  // address of its ROUTER
  Security security;
  std::string name;
  std::uint64_t run_id = 0;
  std::uint64_t incarnation = 0;
  std::uint64_t heartbeat_token = 0;
  std::chrono::nanoseconds heartbeat{};
  std::chrono::nanoseconds silent_after{};  // of the master
  std::chrono::nanoseconds stop_within{0};  // a step that goes on for longer after the end of the
                                            // run or `stop` ends the process; 0: never
  const Event* stop = nullptr;              // may be null
  std::function<std::uint64_t()> progress;  // of the step; called from the heartbeat's thread
  std::function<std::vector<SharedFrames>(const v1::ResendRequest&)> resend;
  std::function<void(v1::Heartbeat*)> add_to_heartbeat;  // may be empty; called there as well
};

/// A node's second thread: tells the master that the process lives and how far its step is, hears
/// the grant again in the answers, and sends again what others have missed - also during a long
/// step.
class HeartbeatThread {
 public:
  /// `resend_socket`: a bound ROUTER, or none.
  HeartbeatThread(zmq::context_t& context, HeartbeatOptions options,
                  std::optional<zmq::socket_t> resend_socket);
  ~HeartbeatThread();
  HeartbeatThread(const HeartbeatThread&) = delete;
  HeartbeatThread& operator=(const HeartbeatThread&) = delete;

  void set_computing(bool computing) { computing_.store(computing, std::memory_order_relaxed); }
  void set_times(const TimeSplit& times);
  /// Set when `latest` has something new; cleared by `latest`.
  const Event& news() const { return news_; }
  v1::Grant latest();

 private:
  void run();
  void beat();
  void hear();
  void answer();
  void post(const v1::Grant& grant);
  void leave_if_stuck();

  HeartbeatOptions options_;
  zmq::socket_t heartbeat_;
  std::optional<zmq::socket_t> resend_;
  std::optional<PeerMonitor> askers_;  // of `resend_`
  Event quit_;
  Event news_;
  std::atomic<bool> computing_{false};
  std::mutex mutex_;  // guards latest_ and times_
  v1::Grant latest_;
  TimeSplit times_;
  std::chrono::nanoseconds heard_;
  std::optional<std::chrono::nanoseconds> over_since_;
  bool over_ = false;
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace dmise
