#pragma once
#include <map>
#include <set>
#include <string>
#include <string_view>

#include "dmise/v1/node.pb.h"
#include "dmise/v1/time.pb.h"

namespace dmise {

/// A process that has joined.
struct Peer {
  std::string routing_id;  // of the connection that stands for it
  std::uint64_t incarnation = 1;
  v1::Join join;  // what it said of itself
  std::uint64_t heartbeat_token = 0;
};

/// Who has joined a run, over which connection, and where each is to be reached.
class PeerDirectory {
 public:
  /// A later process of the same name takes the place of the earlier.
  const Peer& add(std::string_view routing_id, std::uint64_t incarnation, const v1::Join& join,
                  std::uint64_t heartbeat_token = 0);
  /// The same for a node of a host: the connection is its agent's and stands for that.
  const Peer& add_behind(std::string_view agent, std::uint64_t incarnation, const v1::Join& join);

  /// It has left, and its name is free.
  void remove(const std::string& name);

  /// The name behind a connection; "" if none.
  const std::string& name_of(std::string_view routing_id) const;
  /// Null when no such process has joined.
  const Peer* find(const std::string& name, std::uint64_t incarnation) const;
  bool knows(const std::string& name) const { return peers_.contains(name); }
  const std::map<std::string, Peer>& all() const { return peers_; }

  /// Who publishes what, and where; not what depends on whom it is for. Observers are left out.
  v1::Topology topology() const;
  /// The same for an observer, who hears through bounded queues and publishes nothing.
  void make_for_observer(v1::Topology* topology) const;
  /// Topics that somebody consumes.
  std::set<std::string, std::less<>> consumed() const;
  /// Sets `publishers`, `observe_endpoint` and `broker`.
  void describe(v1::Endpoints* endpoints) const;

 private:
  std::map<std::string, Peer> peers_;                      // by name
  std::map<std::string, std::string, std::less<>> names_;  // by routing id
};

}  // namespace dmise
