#pragma once
#include <deque>
#include <map>
#include <set>
#include <string>
#include <string_view>

#include "dmise/v1/node.pb.h"
#include "dmise/v1/time.pb.h"

namespace dmise {

/// A process that has joined.
struct Peer {
  std::string routing_id;  // identifies its connection
  std::uint64_t incarnation = 1;
  v1::Join join;  // its Join message
  std::uint64_t heartbeat_token = 0;
  std::deque<std::string> proved;  // routing ids of the last connections over which it has proved
                                   // to be itself
};

/// The processes of a run with their connections and addresses.
class PeerDirectory {
 public:
  /// Adds a process; it replaces an earlier one of its name.
  void add(std::string_view routing_id, std::uint64_t incarnation, const v1::Join& join,
           std::uint64_t heartbeat_token);
  /// Adds a node of a host, which shares the connection of its agent.
  void add_behind(std::string_view agent, std::uint64_t incarnation, const v1::Join& join,
                  std::uint64_t heartbeat_token);

  /// Notes a connection over which the process has said its token, or whose key is its own.
  void prove(const std::string& name, std::string_view routing_id);
  /// From now on a proved connection stands for its process, and for those behind it, instead of
  /// the one that broke. Returns the name; "" if it is not proved.
  std::string adopt(std::string_view routing_id);

  /// Removes a process that has left; its name is free then.
  void remove(const std::string& name);

  /// The name of a connection; "" if there is none.
  const std::string& name_of(std::string_view routing_id) const;
  /// Null if no such process has joined.
  const Peer* find(const std::string& name, std::uint64_t incarnation) const;
  bool knows(const std::string& name) const { return peers_.contains(name); }
  const std::map<std::string, Peer>& all() const { return peers_; }

  /// Publishers with their topics and addresses, independent of the receiver. Observers are
  /// omitted.
  v1::Topology topology() const;
  /// Makes the topology for an observer, which receives through bounded queues and publishes
  /// nothing.
  void make_for_observer(v1::Topology* topology) const;
  /// Topics with consumers.
  std::set<std::string, std::less<>> consumed() const;
  /// Sets `publishers`, `observe_endpoint` and `broker`, without its password.
  void describe(v1::Endpoints* endpoints) const;

 private:
  std::map<std::string, Peer> peers_;                      // by name
  std::map<std::string, std::string, std::less<>> names_;  // by routing id
};

}  // namespace dmise
