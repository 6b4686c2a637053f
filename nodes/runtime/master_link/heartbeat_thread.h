#pragma once
#include <chrono>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

#include "dmise/v1/node.pb.h"
#include "dmise/v1/time.pb.h"
#include "nodes/runtime/process/event.h"
#include "nodes/runtime/process/seconds.h"
#include "nodes/runtime/protocol/outbox.h"
#include "nodes/runtime/protocol/time_split.h"
#include "nodes/runtime/transport/peer_monitor.h"
#include "nodes/runtime/transport/socket.h"

namespace dmise {

struct HeartbeatOptions {
  std::string master;  // address of its ROUTER
  Security security;
  v1::Welcome welcome;                      // the master's answer to Join
  std::chrono::nanoseconds stop_within{0};  // ends the process if a step lasts longer than this
                                            // after the end of the run or `stop`; 0: never
  const Event* stop = nullptr;              // may be null
  std::function<std::uint64_t()> progress;  // how far the step is; called from the heartbeat thread
  std::function<std::vector<SharedFrames>(const v1::ResendRequest&)> resend;
  // May be empty; called from the heartbeat thread.
  std::function<void(v1::Heartbeat*)> add_to_heartbeat;
};

/// A node's second thread: sends heartbeats with the progress of the step, receives the grant in
/// the replies, and resends messages that others have missed, also during a long step.
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
  /// Set if `latest` has new content; cleared by `latest`.
  const Event& news() const { return news_; }
  v1::Grant latest();

 private:
  void run();
  void beat();
  void handle_replies();
  void answer();
  void post(const v1::Grant& grant);
  void leave_if_stuck();
  Instant silent_after() const { return from_seconds(options_.welcome.silent_after_s()); }

  HeartbeatOptions options_;
  zmq::socket_t heartbeat_;
  std::optional<zmq::socket_t> resend_;
  std::optional<PeerMonitor> askers_;  // who is connected to `resend_`
  Event quit_;
  Event news_;
  std::atomic<bool> computing_{false};
  std::mutex mutex_;  // guards latest_ and times_
  v1::Grant latest_;
  TimeSplit times_;
  std::chrono::nanoseconds heard_;
  std::optional<std::chrono::nanoseconds> over_since_;
  bool over_ = false;
  bool gone_ = false;   // the time-master, after the end
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace dmise
