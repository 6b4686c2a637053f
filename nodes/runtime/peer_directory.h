#pragma once
#include <map>
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
};

/// Who has joined a run, over which connection, and where each is to be reached.
class PeerDirectory {
 public:
  /// A later process of the same name takes the place of the earlier, with the next incarnation.
  const Peer& add(std::string_view routing_id, const v1::Join& join);

  /// The name behind a connection; "" if none.
  const std::string& name_of(std::string_view routing_id) const;
  /// Null when no such process has joined.
  const Peer* find(const std::string& name, std::uint64_t incarnation) const;
  const std::map<std::string, Peer>& all() const { return peers_; }

  v1::Topology topology() const;
  /// Sets `publishers` and `observe_endpoint`.
  void describe(v1::Endpoints* endpoints) const;

 private:
  std::map<std::string, Peer> peers_;                      // by name
  std::map<std::string, std::string, std::less<>> names_;  // by routing id
};

}  // namespace dmise
