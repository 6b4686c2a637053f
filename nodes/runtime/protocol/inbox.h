#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/sim/schedule.h"
#include "core/sim/tally.h"
#include "nodes/wire/receiver.h"

namespace dmise {

/// Messages that a node has received and not yet used. Orders each topic's messages by sequence
/// number, whatever the order of arrival, knows when a tick is complete, and compares messages with
/// their publisher's manifest. A message from the broker, which anybody may have sent, counts only
/// if the publisher's manifest of the tick, received from the time-master, agrees with it;
/// otherwise it is dropped and requested from the publisher.
class Inbox {
 public:
  /// Path of a message.
  enum class Way {
    broker,  // through the broker, untrusted
    direct,  // over a connection to its publisher
    answer,  // reply of the publisher to a request; may be a POSITION
  };
  /// Messages to be requested.
  struct Want {
    std::string topic;
    std::uint64_t from_sequence = 0;
    std::optional<Tick> from_tick;  // instead of a sequence: the position of the topic is unknown,
                                    // or earlier ticks are complete and need not be kept
    bool gap = false;               // known to be published: lost or late
  };

  explicit Inbox(std::vector<std::string> topics);

  /// What is published on `topic` at tick k is needed, and taken, at k + `delay`, >= 1.
  /// `reaches_back`: its ticks that are needed before the one at which the run continues. Call
  /// before `begin_at`.
  void set_delay(const std::string& topic, Tick delay, Tick reaches_back);
  /// Call first: ticks before `tick` are not needed, but retained messages are. With `catch_up`
  /// nothing counts before a POSITION has given each topic's sequence number. `resumes_at`: tick at
  /// which the run continues, at or after `tick`.
  void begin_at(Tick tick, Tick resumes_at, bool catch_up);
  /// First tick of a topic that is needed.
  Tick begins_at(const std::string& topic) const;
  void set_schedule(const std::string& topic, Schedule schedule);
  /// Another process publishes on `topic` from now on: its sequence numbers restart, so its
  /// position must be requested, and its messages of complete ticks are known.
  void restart(const std::string& topic);

  /// Takes a validated message; duplicates and probes change nothing but `probed`.
  void accept(const Received& message, Way way = Way::answer);
  /// Takes the publisher's manifest of a tick. Throws `Error` if the publisher itself has sent
  /// something else.
  void published(const TopicTally& tally, Tick tick);
  /// Nothing is published on `topic` from this tick on.
  void close(const std::string& topic, Tick from_tick);

  /// Whether a probe or later message was received on every topic that is not closed.
  bool probed() const;
  /// Whether every topic is complete for `tick`.
  bool complete(Tick tick) const;
  /// Removes and returns the messages of all ticks up to a complete one, of topics with a delay up
  /// to that much before, ordered by (index of the topic, sequence).
  std::vector<Message> take(Tick tick);
  /// Missing messages that keep `tick` from being complete.
  std::vector<Want> wanted(Tick tick) const;

  /// Number of messages received and not yet taken.
  std::size_t queued() const;
  std::uint64_t duplicates() const { return duplicates_; }
  /// Number of messages no longer available, only for nodes that the clock does not wait for.
  std::uint64_t missed() const { return missed_; }
  /// Number of messages dropped because their publisher's manifest differs.
  std::uint64_t forged() const { return forged_; }

 private:
  struct Waiting {
    Received message;
    bool sure = false;  // from its publisher
  };
  struct Topic {
    std::string name;
    Schedule schedule;
    Tick delay = 0, reaches_back = 0;
    Tick begins_at = 0;
    bool probed = false;
    bool positioned = true;
    bool has_lasting = false;  // has the retained messages
    bool doubted = false;      // messages from the broker differed from the published ones:
                               // everything is requested from the publisher from then on
    bool unannounced = false;  // manifests arrive only after the publisher was asked: it is behind
                               // an agent whose other nodes wait for this one
    std::uint64_t next_sequence = 1;  // the next message that counts
    Tick complete_to = -1;
    Tick closed_from = INT64_MAX;
    std::map<std::uint64_t, Waiting> waiting;    // do not count yet
    std::vector<Message> lasting;                // retained, before the first tick
    std::map<Tick, std::vector<Message>> ready;  // by tick
    std::map<Tick, TopicTally> heard;            // what counts, of ticks not yet taken
    std::map<Tick, TopicTally> manifests;        // the publisher's manifests of them

    /// Whether everything is here that tick `tick` of this node needs.
    bool covers(Tick tick) const {
      tick -= delay;
      return schedule.next_after(complete_to) > tick || tick >= closed_from;
    }
  };
  void position(Topic& topic, const Envelope& envelope);
  void settle(Topic& topic);
  bool settle_group(Topic& topic, std::map<std::uint64_t, Waiting>::iterator end);
  bool contradicts(const Topic& topic) const;
  void doubt(Topic& topic);
  void deliver(Topic& topic, const Received& message);
  void keep_lasting(Topic& topic, const Received& message);
  static bool lacks_published(const Topic& topic);
  void compare(const Topic& topic, Tick tick) const;
  Topic* find(std::string_view name);

  std::vector<Topic> topics_;
  std::map<std::string, std::size_t, std::less<>> place_;
  std::uint64_t duplicates_ = 0;
  std::uint64_t missed_ = 0;
  std::uint64_t forged_ = 0;
};

}  // namespace dmise
