#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/fold_digest.h"
#include "core/base/sim_time.h"

namespace dmise {

/// What a node has published on one topic at one tick, as it says itself. What is said once and for all
/// (a roster) does not count: a process that follows another says it again.
struct TopicTally {
  std::string topic;
  std::uint64_t messages = 0;       // of this tick, a watermark counts
  std::uint64_t last_sequence = 0;  // of the publisher on this topic
  std::uint64_t digest = 0;         // of kinds, payloads and arrays; not of envelopes

  /// The same content, whatever process published it: sequences count within an incarnation.
  bool same_content(const TopicTally& other) const {
    return topic == other.topic && messages == other.messages && digest == other.digest;
  }
};

/// A node's whole manifest of one tick.
struct TickTally {
  Tick tick = 0;
  std::vector<TopicTally> topics;  // in the order of the node's list
  std::uint64_t incarnation = 0;   // of the process that said so
};

}  // namespace dmise
