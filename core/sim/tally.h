#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/files/fold_digest.h"
#include "core/base/sim_time.h"

namespace dmise {

/// What a node has published on one topic at one tick, as it reports. Retained messages (a roster)
/// do not count: a process that replaces another publishes them again.
struct TopicTally {
  std::string topic;
  std::uint64_t messages = 0;       // at this tick, including the watermark
  std::uint64_t last_sequence = 0;  // number of the publisher's last one on this topic
  std::uint64_t digest = 0;         // over kinds, payloads and arrays; not over envelopes
  std::uint64_t incarnation = 0;    // identifies the reporting process

  /// Whether the content is the same, whatever process published it: sequences count within an
  /// incarnation.
  bool same_content(const TopicTally& other) const {
    return topic == other.topic && messages == other.messages && digest == other.digest;
  }
};

/// A node's manifest of one tick, or that of a host for topics needed by others.
struct TickTally {
  Tick tick = 0;
  std::vector<TopicTally> topics;  // in the order of the node's list
  std::uint64_t digest = 0;        // a host's is the sum of its nodes' content_digest
};

/// Returns the contribution of a node's tick to the digest of a run, which is the sum over all
/// nodes and ticks and so does not depend on their order. 0 for a node without topics.
inline std::uint64_t content_digest(std::string_view node, const TickTally& tally) {
  if (tally.topics.empty()) return 0;
  std::uint64_t digest = fold_digest(0, std::uint64_t(tally.tick));
  for (const char c : node) digest = fold_digest(digest, static_cast<unsigned char>(c));
  for (const TopicTally& topic : tally.topics)
    digest = fold_digest(fold_digest(digest, topic.messages), topic.digest);
  return digest;
}

}  // namespace dmise
