#pragma once
#include <mutex>

#include "core/base/instant.h"
#include "nodes/agent/host_agent.h"
#include "nodes/agent/host_barrier.h"
#include "nodes/agent/host_publisher.h"
#include "nodes/runtime/master_link/master_link.h"
#include "nodes/runtime/protocol/topic_owners.h"
#include "nodes/runtime/transport/broker_connection.h"
#include "nodes/runtime/transport/peer_monitor.h"

namespace dmise {

/// The process of an agent. host_agent.cpp is its loop and its side towards the run,
/// host_agent_nodes.cpp handles the nodes of the host.
class HostAgentProcess {
 public:
  HostAgentProcess(const HostAgentOptions& options, HostAgentResult* result);
  void run();

 private:
  void join();
  void suspect(const std::vector<std::string>& names);
  bool over() const { return link_.over() || link_.stopped(); }

  /// Handles the messages of this host's nodes.
  void handle_nodes();
  void join_of(std::string_view sender, zmq::message_t& frame);
  void done(const std::string& name);
  void heartbeat(std::string_view sender, zmq::message_t& frame);
  void leave_of(const std::string& name);
  void forward(const v1::Join& join);
  void adopt(std::string_view sender);

  /// Relays data in both directions.
  void relay();

  /// Applies the master's last grant.
  void apply_grant();
  void welcome(v1::MasterMessage answer);
  void follow_topology();
  /// To all nodes of this host, or to one.
  void send_topology(const std::string& only = "");

  /// Reports this host's state to the master.
  void report_to_master();
  void send_news();
  /// After the connection to the master broke: what may not have arrived.
  void repeat_reports();

  /// Collects nodes' beats for the next heartbeat.
  void collect_beats();
  void leave();
  const HostAgentOptions& options_;
  HostAgentResult* result_;
  zmq::context_t context_{1};
  Security security_;
  ZapAuthenticator authenticator_;
  std::mutex mutex_;     // guards beats_
  v1::Heartbeat beats_;  // used by the heartbeat thread, must outlive it
  MasterLink link_;
  zmq::socket_t router_, ticks_;            // the nodes' time-master
  zmq::socket_t publishers_, subscribers_;  // the nodes' broker
  zmq::socket_t to_broker_, from_broker_;   // the run's
  PeerMonitor connections_, subscriptions_, tick_subscriptions_;
  std::vector<std::uint64_t> broken_;  // connections that have just broken
  PeerDirectory directory_;
  TopicOwners owners_;
  HostPublisher publisher_;
  std::optional<HostBarrier> barrier_;
  std::map<std::string, Peer> joining_;  // nodes whose Join is unanswered
  std::map<std::string, v1::TimeSplit> times_;
  std::set<std::string, std::less<>> reported_;  // topics whose tallies the master needs
  std::string address_, tick_endpoint_, publish_endpoint_, subscribe_endpoint_;
  BrokerConnection at_subscribe_{from_broker_}, at_publish_{to_broker_};
  std::uint64_t topology_version_ = 0;
  v1::NodeMessage heard_;
  Instant busy_{0};
  std::uint64_t beats_noted_ = 0;
  double cpu_began_ = -1.0;
  bool said_ready_ = false;
};

}  // namespace dmise
