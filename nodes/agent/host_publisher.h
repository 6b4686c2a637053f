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

/// What an agent says to the nodes of its host, in the words of the time-master.
class HostPublisher {
 public:
  HostPublisher(zmq::socket_t& router, zmq::socket_t& ticks, const PeerDirectory& directory)
      : router_(router), ticks_(ticks), directory_(directory) {}

  void reply(std::string_view routing_id, const v1::MasterMessage& message);
  void refuse(std::string_view routing_id, const std::string& reason);
  /// The grant that holds from now on, without manifests.
  void set_grant(v1::Grant grant, Tick settled);
  /// What somebody has published; told to those of this host who consume it.
  void note(const v1::TopicTally& tally);
  /// Says grant and manifests if there is something new, or anyhow.
  void say(bool anyhow);
  /// The same for one node, with the manifests of all that it may still wait for.
  v1::MasterMessage grant_for(const v1::Join& node) const;
  /// The run's last word to a process that is no longer part of it.
  v1::MasterMessage expelled(const std::string& cause) const;
  /// Tells each node who is where: the agent itself is their broker.
  void send_topology(const v1::Topology& topology, const std::string& publish_endpoint,
                     const std::string& subscribe_endpoint, const std::string& password);

 private:
  zmq::socket_t& router_;
  zmq::socket_t& ticks_;
  const PeerDirectory& directory_;
  v1::Grant grant_;
  v1::Grant fresh_;  // `published` that has not been told yet
  bool changed_ = false;
  std::set<std::string, std::less<>> consumed_;             // topics that somebody here consumes
  std::map<std::string, std::deque<v1::TopicTally>> said_;  // of ticks not settled, by topic
};

}  // namespace dmise
