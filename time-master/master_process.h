#pragma once
#include "core/base/instant.h"
#include "nodes/runtime/process/limited_log.h"
#include "nodes/runtime/protocol/peer_directory.h"
#include "nodes/runtime/protocol/topic_owners.h"
#include "nodes/runtime/transport/peer_monitor.h"
#include "nodes/runtime/transport/socket.h"
#include "time-master/clock_watch.h"
#include "time-master/control_inbox.h"
#include "time-master/coordinator.h"
#include "time-master/master.h"
#include "time-master/master_publisher.h"
#include "time-master/tick_log.h"

namespace dmise {

using NodeBeats = google::protobuf::RepeatedPtrField<v1::NodeBeat>;

/// Random and never 0.
std::uint64_t random_number();

/// The process of a time-master: the coordinator behind its sockets. master.cpp is its loop,
/// master_control.cpp handles control messages.
class MasterProcess {
 public:
  explicit MasterProcess(const MasterOptions& options);
  MasterResult run();

 private:
  void update_metrics() const;
  void wait(Instant at_most);

  /// While this process was suspended it could not receive anything; after a long time nodes may
  /// have given it up.
  void check_suspension(Instant since);
  void suspect(const std::vector<std::string>& names);
  void receive_all();

  /// Whether the clock waits for this member.
  bool is_timekeeper(const std::string& name) const;

  /// Handles a message of a member. False for requests open to anybody, which are queued.
  bool handle_member(ControlMessage& message);

  /// Whether a message expects a reply.
  bool expects_reply(const zmq::message_t& body);
  void handle_stranger(ControlMessage& message);

  /// `name`: the member whose connection it came over, if any.
  void handle(ControlMessage& message, const std::string& name);

  /// Drops the state of processes that are no longer part of the run.
  void drop_removed();
  void look_after_strangers();

  /// Closes connections beyond their limits.
  void enforce_limits();
  void refuse(std::string_view sender, const std::string& fault);
  void refuse_join(std::string_view sender, const std::string& reason, const std::string& name);
  void done(const std::string& name);
  void control();
  void join(std::string_view sender, zmq::message_t& frame);
  /// Whether this connection has joined with the same words already, and asks again since the
  /// answer may be lost.
  bool has_joined(const v1::Join& join, const std::string& stands_for) const;
  /// A process whose connection broke continues over another, over which it has proved itself.
  void adopt(std::string_view sender);
  void heartbeat(std::string_view sender, zmq::message_t& frame);
  void leave(const std::string& name);

  /// Handles an agent's report on the nodes behind it.
  void handle_host_report(const std::string& agent, const NodeBeats& nodes,
                          std::vector<std::string> holding);
  void handle_news(const std::string& agent);

  /// Publishes changes.
  void advance();
  void fill(v1::Endpoints* endpoints) const;
  MasterResult result() const;
  const MasterOptions& options_;
  Coordinator coordinator_;
  zmq::context_t context_{1};
  Security security_;
  ZapAuthenticator authenticator_;
  zmq::socket_t router_, ticks_;
  PeerMonitor connections_, listeners_;  // who is connected to `router_`, and to `ticks_`
  std::vector<std::uint64_t> broken_;    // whose last messages may not have been handled
  Instant broken_since_{0};
  std::uint64_t run_id_;
  std::string address_, tick_endpoint_;
  std::vector<zmq::pollitem_t> items_;
  PeerDirectory directory_;
  TopicOwners owners_;
  ControlInbox inbox_;
  PeerRates refusals_;              // by connection
  PeerRates answers_{RateLimit{}};  // to heartbeats, by name
  LimitedLog log_;
  std::uint64_t ignored_ = 0;
  Instant next_ignored_line_{0};
  MasterPublisher publisher_;
  std::map<std::string, TimeSplit> times_;
  v1::NodeMessage heard_;
  ClockWatch watch_;
  TickLog tick_log_;
  std::optional<Instant> started_, ended_;
  std::uint64_t messages_ = 0;
  double cpu_s_ = 0.0;
};

}  // namespace dmise
