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

/// What a node has received and not yet used: brings each topic's messages into the order of their
/// sequence numbers, whatever the order of arrival, knows when a tick is complete, and compares
/// what came with what its publisher says it published. What came through the broker counts when
/// the publisher's manifest of the tick, which comes from the time-master, agrees with it: anybody
/// may have sent it. If not, it is thrown away and the publisher itself is asked.
class Inbox {
 public:
  /// How a message came.
  enum class Way {
    broker,  // from whoever reaches the broker
    direct,  // over a connection to its publisher
    answer,  // the same, to a question of ours: it may say where a topic is (POSITION)
  };
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
  void accept(const Received& message, Way way = Way::answer);
  /// What the publisher says of a tick. Throws `Error` when it has itself sent something else.
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
  /// Messages thrown away because their publisher's manifest says otherwise.
  std::uint64_t forged() const { return forged_; }

 private:
  struct Waiting {
    Received message;
    bool sure = false;  // it came from its publisher
  };
  struct Topic {
    std::string name;
    Schedule schedule;
    bool probed = false;
    bool positioned = true;
    bool has_lasting = false;  // heard what is said once and for all
    bool doubted = false;      // something else came through the broker than was published: the
                               // publisher is asked for everything from then on
    bool unsaid = false;       // manifests come only after the publisher was asked: it is behind an
                               // agent whose other nodes wait for this one
    std::uint64_t next_sequence = 1;  // the first that does not count yet
    Tick complete_to = -1;
    Tick closed_from = INT64_MAX;
    std::map<std::uint64_t, Waiting> waiting;    // do not count yet
    std::vector<Message> lasting;                // said once and for all, before the first tick
    std::map<Tick, std::vector<Message>> ready;  // by tick
    std::map<Tick, TopicTally> heard;            // what counts, of ticks not yet taken
    std::map<Tick, TopicTally> said;             // what the publisher says of them

    bool covers(Tick tick) const {
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
