#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/sim/schedule.h"
#include "nodes/wire/receiver.h"
#include "time-master/tally.h"

namespace dmise {

/// What a node has received and not yet used: brings each topic's messages into the order of their
/// sequence numbers, whatever the order of arrival, knows when a tick is complete, and compares
/// what came with what its publisher says it published.
class Inbox {
 public:
  /// Messages to be asked for again.
  struct Want {
    std::string topic;
    std::uint64_t from_sequence = 0;
    std::optional<Tick> from_tick;  // instead: it is not known where the topic is, or earlier ticks
                                    // are complete and need not be kept
    bool gap = false;               // known to be published: this one is lost or late
  };

  explicit Inbox(std::vector<std::string> topics);

  /// Before anything else: ticks before `tick` are not needed, but what was said once and for all
  /// is. With `catch_up` nothing counts before a POSITION has said where each topic is.
  void begin_at(Tick tick, bool catch_up);
  void set_schedule(const std::string& topic, Schedule schedule);
  /// Another process publishes on `topic` from now on: its numbers start again, so that it must be
  /// asked where it is, and what it says of ticks that are complete is known already.
  void restart(const std::string& topic);

  /// Takes a message that passed the receiver; duplicates and probes change nothing but `probed`.
  void accept(const Received& message);
  /// What the publisher says of a tick. Throws `Error` when something else came.
  void published(const TopicTally& tally, Tick tick);
  /// Nothing is said on `topic` from this tick on.
  void close(const std::string& topic, Tick from_tick);

  /// True once a probe (or anything later) was received over every topic.
  bool probed() const;
  /// True when it is known where every topic is.
  bool positioned() const;
  /// True when every topic is complete for `tick`.
  bool complete(Tick tick) const;
  /// The messages of all ticks up to a complete one that were not taken, ordered by (place of the
  /// topic, sequence); forgets them.
  std::vector<Message> take(Tick tick);
  /// Topics that keep `tick` from being complete.
  std::vector<Want> wanted(Tick tick) const;

  /// Messages received and not yet taken.
  std::size_t queued() const;
  std::uint64_t duplicates() const { return duplicates_; }
  /// Messages that nobody keeps any more; only those who hold nobody's time have such.
  std::uint64_t missed() const { return missed_; }

 private:
  struct Topic {
    std::string name;
    Schedule schedule;
    bool probed = false;
    bool positioned = true;
    bool has_lasting = false;  // heard what is said once and for all
    std::uint64_t next_sequence = 1;
    Tick complete_to = -1;  // watermark
    Tick closed_from = INT64_MAX;
    std::map<std::uint64_t, Received> early;     // arrived before their turn
    std::vector<Message> lasting;                // said once and for all, before the first tick
    std::map<Tick, std::vector<Message>> ready;  // by tick
    std::map<Tick, TopicTally> heard;            // what came, of ticks not yet taken
    std::map<Tick, TopicTally> said;             // what the publisher says of them

    bool covers(Tick tick) const {
      return schedule.next_after(complete_to) > tick || tick >= closed_from;
    }
  };
  void position(Topic& topic, const Envelope& envelope);
  void deliver(Topic& topic, const Received& message);
  void deliver_early(Topic& topic);
  void compare(const Topic& topic, Tick tick) const;
  Topic* find(std::string_view name);

  std::vector<Topic> topics_;
  std::map<std::string, std::size_t, std::less<>> place_;
  std::uint64_t duplicates_ = 0;
  std::uint64_t missed_ = 0;
};

}  // namespace dmise
