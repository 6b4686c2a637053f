#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "nodes/wire/receiver.h"

namespace dmise {

/// What a node has received and not yet used: brings each topic's messages into the order of their
/// sequence numbers, whatever the order of arrival, and knows when a tick is complete.
class Inbox {
 public:
  /// Messages to be asked for again.
  struct Want {
    std::string topic;
    std::uint64_t from_sequence = 0;
    bool gap = false;  // later ones have arrived: this one is lost or late
  };

  explicit Inbox(std::vector<std::string> topics);

  /// Takes a message that passed the receiver; duplicates and probes change nothing but `probed`.
  void accept(const Received& message);
  /// Nothing is said on `topic` from this tick on.
  void close(const std::string& topic, Tick from_tick);

  /// True once a probe (or anything later) was received over every topic.
  bool probed() const;
  /// True when every topic is complete for `tick`.
  bool complete(Tick tick) const;
  /// The messages of a complete tick, ordered by (place of the topic, sequence); forgets them.
  std::vector<Message> take(Tick tick);
  /// Topics that keep `tick` from being complete.
  std::vector<Want> wanted(Tick tick) const;

  std::uint64_t duplicates() const { return duplicates_; }

 private:
  struct Topic {
    std::string name;
    bool probed = false;
    std::uint64_t next_sequence = 1;
    Tick complete_to = -1;  // watermark
    Tick closed_from = INT64_MAX;
    std::map<std::uint64_t, Received> early;     // arrived before their turn
    std::map<Tick, std::vector<Message>> ready;  // by tick
  };
  void deliver(Topic& topic, const Received& message);

  std::vector<Topic> topics_;
  std::map<std::string, std::size_t, std::less<>> place_;
  std::uint64_t duplicates_ = 0;
};

}  // namespace dmise
