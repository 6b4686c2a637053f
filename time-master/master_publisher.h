#pragma once
#include <set>
#include <string>
#include <string_view>
#include <zmq.hpp>

#include "dmise/v1/node.pb.h"
#include "dmise/v1/time.pb.h"
#include "nodes/runtime/protocol/peer_directory.h"
#include "time-master/coordinator.h"

namespace dmise {

/// What the time-master says: grants to all, answers to one, and who is where to each.
class MasterPublisher {
 public:
  /// `router`: the socket of all conversations; `ticks`: the PUB that all hear. All outlive this.
  MasterPublisher(zmq::socket_t& router, zmq::socket_t& ticks, std::uint64_t run_id,
                  const Coordinator& coordinator, const PeerDirectory& directory)
      : router_(router),
        ticks_(ticks),
        run_id_(run_id),
        coordinator_(coordinator),
        directory_(directory) {}

  void reply(std::string_view routing_id, const v1::MasterMessage& message);
  void refuse(std::string_view routing_id, const std::string& reason, const std::string& name);
  /// To be told to all who consume with what is said next.
  void note(const TickTally& tally);
  /// An observer has joined a run under way: nobody else needs to know, but agents what it wants.
  void announce_observer(const std::string& name);
  /// Says what has changed since it was last said; true if something had.
  bool publish_changes();
  /// Says the grant as it is now.
  void publish();

  v1::MasterMessage welcome(const std::string& name, const std::string& tick_endpoint,
                            std::uint64_t heartbeat_token) const;
  /// The grant as it is now.
  v1::MasterMessage grant() const;
  /// The same for the process `member`, with the manifests of all that it may still wait for.
  v1::MasterMessage grant_for(const Coordinator::Member& member) const;
  /// The run's last word to a process that is no longer part of it.
  v1::MasterMessage expelled(const std::string& cause) const;

  /// As last said.
  Phase phase() const { return phase_; }

 private:
  void send_topology();
  void send_topology_to(const Peer& peer, const v1::Topology& topology);

  zmq::socket_t& router_;
  zmq::socket_t& ticks_;
  std::uint64_t run_id_;
  const Coordinator& coordinator_;
  const PeerDirectory& directory_;
  v1::Grant grant_;
  v1::Grant fresh_;                              // `published` that has not been told yet
  std::set<std::string, std::less<>> consumed_;  // topics that somebody consumes
  std::uint64_t topology_version_ = 0;           // as last told
  Phase phase_ = Phase::gathering;
  Tick granted_ = -1;
};

}  // namespace dmise
