#pragma once
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>
#include <zmq.hpp>

#include "dmise/v1/node.pb.h"
#include "dmise/v1/time.pb.h"
#include "nodes/runtime/protocol/peer_directory.h"
#include "time-master/coordinator.h"

namespace dmise {

/// Sends the time-master's messages: grants to all, replies to one, and the topology to each.
class MasterPublisher {
 public:
  /// `router`: the socket of all conversations; `ticks`: the PUB of grants. All must outlive this.
  MasterPublisher(zmq::socket_t& router, zmq::socket_t& ticks, std::uint64_t run_id,
                  const Coordinator& coordinator, const PeerDirectory& directory)
      : router_(router),
        ticks_(ticks),
        run_id_(run_id),
        coordinator_(coordinator),
        directory_(directory) {}

  void reply(std::string_view routing_id, const v1::MasterMessage& message);
  void refuse(std::string_view routing_id, const std::string& reason, const std::string& name);
  /// Records a manifest, sent with the next message: to all, or only to its consumers if they are
  /// few.
  void note(const TickTally& tally);
  /// An observer has joined a running run: only agents need to know its topics.
  void announce_observer(const std::string& name);
  /// What may have been lost on the way to a process whose connection broke: topology and grant.
  void send_again(const std::string& name);
  /// Sends what has changed since the last call; true if anything had.
  bool publish_changes();
  /// Sends the current grant.
  void publish();

  v1::MasterMessage welcome(const std::string& name, const std::string& tick_endpoint,
                            std::uint64_t heartbeat_token) const;
  /// The current grant.
  v1::MasterMessage grant() const;
  /// The grant for the process `member`, with the manifests of all ticks that it may still wait
  /// for.
  v1::MasterMessage grant_for(const Coordinator::Member& member) const;
  /// The final message to a process that is no longer part of the run.
  v1::MasterMessage expelled(const std::string& cause) const;

  /// Phase as last sent.
  Phase phase() const { return phase_; }

 private:
  void index_consumers();
  void publish_to_few();
  void send_topology();
  void send_topology_to(const Peer& peer, const v1::Topology& topology);

  zmq::socket_t& router_;
  zmq::socket_t& ticks_;
  std::uint64_t run_id_;
  const Coordinator& coordinator_;
  const PeerDirectory& directory_;
  v1::Grant grant_;
  // Manifests that have not been sent yet: to all, and to single processes.
  v1::Grant fresh_;
  std::map<std::string, v1::Grant> fresh_for_;
  std::set<std::string, std::less<>> consumed_;             // topics with consumers
  std::map<std::string, std::vector<std::string>> narrow_;  // few consumers: their names
  std::uint64_t topology_version_ = 0;                      // as last sent
  Phase phase_ = Phase::gathering;
  Tick granted_ = -1;
};

}  // namespace dmise
