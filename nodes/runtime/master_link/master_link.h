#pragma once
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/sim/tally.h"
#include "dmise/v1/node.pb.h"
#include "dmise/v1/time.pb.h"
#include "nodes/runtime/master_link/heartbeat_thread.h"

namespace dmise {

/// A process's connection to the time-master: joins, receives grants (published, and repeated in
/// replies to heartbeats), reports, leaves. Used from one thread.
///
/// The master knows the process by this connection. When it breaks, the process proves over the
/// next one that it is the same, by its token or key, holds its messages until the master has
/// answered, and repeats those that may be lost.
class MasterLink {
 public:
  MasterLink(zmq::context_t& context, std::string master, const Event* stop,
             const Security& security = {});
  ~MasterLink();

  /// Throws `Error` if refused or if there is no answer within the time.
  v1::Welcome join(const v1::Join& request, std::chrono::nanoseconds within);

  /// Starts the heartbeat. `options` needs only what `join` does not know.
  void keep(HeartbeatOptions options, std::optional<zmq::socket_t> resend_socket);
  /// Sent with the next heartbeat.
  void set_computing(bool computing) { heartbeat_->set_computing(computing); }
  void set_times(const TimeSplit& times) {
    times_ = times;
    heartbeat_->set_times(times);
  }
  /// Called when the master knows a process again whose connection broke, to repeat messages other
  /// than `ready` and `done`.
  void on_return(std::function<void()> repeat) { repeat_ = std::move(repeat); }

  void ready();
  /// It was, and is no longer.
  void not_ready() { ready_ = false; }
  void done(const TickTally& tally);
  void leave(bool interrupted, const TimeSplit& times);
  void failed(const std::string& reason);
  /// Sends any message, over the connection that identifies the process.
  void send(v1::NodeMessage message);

  /// Waits until a message of the master arrives, one of `sockets` is readable, the process is
  /// asked to stop, or the time is over; handles the messages.
  void wait(const std::vector<zmq::socket_t*>& sockets, std::chrono::nanoseconds at_most);

  Tick granted() const { return granted_; }
  v1::Phase phase() const { return phase_; }
  bool over() const { return phase_ == v1::PHASE_ENDED || phase_ == v1::PHASE_FAILED; }
  const std::string& cause() const { return cause_; }
  bool deserted() const { return deserted_; }
  bool stopped() const { return stop_ && stop_->is_set(); }
  /// Whether a grant arrived over the published channel, so that none will be missed.
  bool receives_ticks() const { return receives_ticks_; }
  const std::string& name() const { return name_; }
  const std::optional<v1::Topology>& topology() const { return topology_; }
  /// Increases with every topology received.
  std::uint64_t topology_version() const { return topology_version_; }
  /// Manifests published since the last call.
  std::vector<v1::TopicTally> take_published() { return std::exchange(published_, {}); }
  const std::vector<v1::ClosedTopic>& closed() const { return closed_; }
  /// Answers to Join for other processes since the last call: an agent joins for its nodes.
  std::vector<v1::MasterMessage> take_answers() { return std::exchange(answers_, {}); }
  const v1::Welcome& welcome() const { return welcome_; }

 private:
  void handle_control();
  void handle_ticks();
  void post(v1::NodeMessage message);
  void notice_breaks();
  void prove();
  void go_on();
  void await_return();
  void take(const v1::Grant& grant);

  zmq::context_t& context_;
  std::string master_;
  Security security_;
  const Event* stop_;
  std::string name_;
  zmq::socket_t control_;
  zmq::socket_t breaks_;  // tells when `control_` breaks
  zmq::socket_t ticks_;
  std::unique_ptr<HeartbeatThread> heartbeat_;
  std::vector<zmq::pollitem_t> items_;

  v1::Join request_;
  v1::Welcome welcome_;
  std::optional<v1::MasterMessage> answer_;  // to Join
  std::vector<v1::MasterMessage> answers_;   // to Join of others
  std::optional<v1::Topology> topology_;
  std::uint64_t topology_version_ = 0;
  std::vector<v1::ClosedTopic> closed_;
  std::vector<v1::TopicTally> published_;
  v1::Grant scratch_;
  Tick granted_ = -1;
  v1::Phase phase_ = v1::PHASE_GATHERING;
  std::string cause_;
  bool deserted_ = false;
  bool receives_ticks_ = false;
  TimeSplit times_;
  bool connected_ = false;
  Instant look_at_{0};  // when to look for a broken connection next
  bool ready_ = false;
  std::deque<TickTally> done_;         // ticks that the master may not have heard of
  std::vector<v1::NodeMessage> held_;  // until it knows this process again
  std::optional<Instant> prove_at_;    // not yet known again: when to try next
  std::function<void()> repeat_;
};

}  // namespace dmise
