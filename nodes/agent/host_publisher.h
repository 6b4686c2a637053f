#pragma once
#include <deque>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <zmq.hpp>

#include "core/base/sim_time.h"
#include "dmise/v1/node.pb.h"
#include "dmise/v1/time.pb.h"
#include "nodes/runtime/protocol/peer_directory.h"

namespace dmise {

/// Sends messages of an agent to the nodes of its host, in place of the time-master.
class HostPublisher {
 public:
  HostPublisher(zmq::socket_t& router, zmq::socket_t& ticks, const PeerDirectory& directory)
      : router_(router), ticks_(ticks), directory_(directory) {}

  void reply(std::string_view routing_id, const v1::MasterMessage& message);
  void refuse(std::string_view routing_id, const std::string& reason);
  /// Sets the current grant, without manifests.
  void set_grant(v1::Grant grant, Tick settled);
  /// Records a publication, for the nodes of this host that consume it.
  void note(const v1::TopicTally& tally);
  /// Sends grant and manifests if they have changed, or always if `anyhow`.
  void publish(bool anyhow);
  /// The grant for one node, with the manifests of all ticks that it may still wait for.
  v1::MasterMessage grant_for(const v1::Join& node) const;
  /// The final message to a process that is no longer part of the run.
  v1::MasterMessage expelled(const std::string& cause) const;
  /// Sends each node, or only one, the topology, with the agent as its broker.
  void send_topology(const v1::Topology& topology, const std::string& publish_endpoint,
                     const std::string& subscribe_endpoint, const std::string& password,
                     const std::string& only = "");

 private:
  zmq::socket_t& router_;
  zmq::socket_t& ticks_;
  const PeerDirectory& directory_;
  v1::Grant grant_;
  v1::Grant fresh_;  // `published` that has not been sent yet
  bool changed_ = false;
  std::set<std::string, std::less<>> consumed_;  // topics consumed on this host
  std::map<std::string, std::deque<v1::TopicTally>>
      manifests_;  // tallies of ticks not settled, by topic
};

}  // namespace dmise
