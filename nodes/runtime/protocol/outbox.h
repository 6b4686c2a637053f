#pragma once
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/sim/schedule.h"
#include "core/sim/tally.h"
#include "nodes/wire/receiver.h"

namespace dmise {

using SharedFrames = std::shared_ptr<const Frames>;

/// Messages that a node publishes: seals and numbers them, closes each topic at each tick, and
/// keeps the last ticks for requests. `since` may be called from another thread.
class Outbox {
 public:
  /// `keep_ticks`: the largest number of ticks that a consumer may be behind.
  Outbox(RunFacts run, std::string publisher, std::uint64_t incarnation,
         std::vector<std::string> topics, Tick keep_ticks);

  /// Sets the number of ticks to keep from now on. Call before the first `pack`.
  void keep(Tick ticks) { keep_ticks_ = ticks; }

  /// Nothing is published on `topic` at other ticks. Call before the first `pack`.
  void set_schedule(const std::string& topic, Schedule schedule) { schedules_[topic] = schedule; }

  std::vector<SharedFrames> probes() const;

  /// The messages of one tick in order of sending; a topic without messages gets a watermark
  /// where its schedule has the tick. Throws `Error` for a topic that is not this node's or a
  /// message of another tick.
  std::vector<SharedFrames> pack(Tick tick, const std::vector<Message>& messages);

  /// Manifest of the last `pack`.
  const TickTally& tally() const { return tally_; }

  /// Kept messages of a topic from a sequence number on.
  std::vector<SharedFrames> since(const std::string& topic, std::uint64_t sequence) const;
  /// Retained messages, a POSITION, and the kept messages from a tick on. Empty for a topic that is
  /// not this node's.
  std::vector<SharedFrames> catch_up(const std::string& topic, Tick from_tick) const;

 private:
  struct Kept {
    std::uint64_t sequence = 0;
    Tick tick = 0;
    SharedFrames frames;
  };
  bool is_due(const std::string& topic, Tick tick) const;
  void forget_before(Tick tick);

  RunFacts run_;
  std::string publisher_;
  std::uint64_t incarnation_;
  std::vector<std::string> topics_;
  Tick keep_ticks_;
  std::map<std::string, Schedule> schedules_;  // only topics not published at every tick
  std::map<std::string, std::uint64_t> sequence_;
  TickTally tally_;
  mutable std::mutex mutex_;  // guards what follows
  std::map<std::string, std::deque<Kept>> kept_;
  std::map<std::string, SharedFrames> lasting_;  // the last retained message
  std::map<std::string, std::uint64_t> next_;    // sequence number of the next message
  Tick next_tick_ = 0;
};

}  // namespace dmise
