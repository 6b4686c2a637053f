#pragma once
#include <algorithm>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "time-master/pace.h"

namespace dmise {

/// Rate limit: `burst` events at once, then one per `interval`.
struct RateLimit {
  int burst = 32;
  Instant interval = std::chrono::milliseconds(10);
};

/// State of a RateLimit, by the generic cell rate algorithm (ITU-T I.371). A full bucket equals a
/// new one.
class TokenBucket {
 public:
  bool take(const RateLimit& limit, Instant now) {
    if (now < next(limit)) return false;
    full_at_ = std::max(full_at_, now) + limit.interval;
    return true;
  }
  bool is_full(Instant now) const { return full_at_ <= now; }
  /// When `take` succeeds next.
  Instant next(const RateLimit& limit) const {
    return full_at_ - (limit.burst - 1) * limit.interval;
  }

 private:
  Instant full_at_{0};
};

/// A bucket for each peer; nothing is stored for idle peers.
class PeerRates {
 public:
  explicit PeerRates(const RateLimit& limit) : limit_(limit) {}

  bool take(std::string_view peer, Instant now) { return bucket(peer, now).take(limit_, now); }
  Instant next(std::string_view peer, Instant now) { return bucket(peer, now).next(limit_); }
  std::size_t size() const { return buckets_.size(); }

  /// Removes idle peers. `take` does so from time to time.
  void forget_quiet(Instant now) {
    for (auto bucket = buckets_.begin(); bucket != buckets_.end();)
      bucket = bucket->second.is_full(now) ? buckets_.erase(bucket) : std::next(bucket);
    next_sweep_ = now + std::chrono::seconds(1);
  }

 private:
  TokenBucket& bucket(std::string_view peer, Instant now) {
    if (now >= next_sweep_) forget_quiet(now);
    const auto found = buckets_.find(peer);
    if (found != buckets_.end()) return found->second;
    return buckets_.emplace(peer, TokenBucket()).first->second;
  }

  RateLimit limit_;
  std::map<std::string, TokenBucket, std::less<>> buckets_;
  Instant next_sweep_{0};
};

struct StrangerLimits {
  std::size_t messages_of_a_peer = 8;  // queued
  std::size_t messages = 4096;         // queued, of all peers
  std::size_t bytes = 16 << 20;        // queued, of all peers
  RateLimit rate;                      // for each peer
};

/// Queue of messages of processes that the clock does not wait for: peers take turns, each at a
/// limited rate, and messages beyond the limits are ignored and counted.
template <class Message>
class UnauthenticatedPeers {
 public:
  explicit UnauthenticatedPeers(const StrangerLimits& limits)
      : limits_(limits), rates_(limits.rate) {}

  /// False when the message is ignored.
  bool push(std::string_view peer, Message message, std::size_t bytes) {
    const auto found = waiting_.find(peer);
    const std::size_t own = found == waiting_.end() ? 0 : found->second.size();
    if (own >= limits_.messages_of_a_peer || messages_ >= limits_.messages ||
        bytes_ + bytes > limits_.bytes) {
      ++ignored_;
      return false;
    }
    auto& queue = found != waiting_.end() ? found->second : waiting_[std::string(peer)];
    queue.emplace_back(std::move(message), bytes);
    if (own == 0) turns_.emplace_back(peer);
    ++messages_;
    bytes_ += bytes;
    return true;
  }

  /// The next message in turn; empty while the waiting peers are beyond their rate.
  std::optional<Message> take(Instant now) {
    for (std::size_t looked = turns_.size(); looked > 0; --looked) {
      const std::string peer = std::move(turns_.front());
      turns_.pop_front();
      if (!rates_.take(peer, now)) {
        turns_.push_back(peer);
        continue;
      }
      const auto found = waiting_.find(peer);
      auto [message, bytes] = std::move(found->second.front());
      found->second.pop_front();
      --messages_;
      bytes_ -= bytes;
      if (found->second.empty())
        waiting_.erase(found);
      else
        turns_.push_back(peer);
      return std::move(message);
    }
    return std::nullopt;
  }

  /// When `take` returns a message, unless more arrive; empty if none are waiting.
  std::optional<Instant> next_due(Instant now) {
    std::optional<Instant> next;
    for (const std::string& peer : turns_) {
      const Instant due = rates_.next(peer, now);
      if (!next || due < *next) next = due;
      if (*next <= now) break;
    }
    return next;
  }

  std::size_t size() const { return messages_; }
  /// Messages ignored since the last call.
  std::uint64_t take_ignored() { return std::exchange(ignored_, 0); }

 private:
  StrangerLimits limits_;
  PeerRates rates_;
  std::map<std::string, std::deque<std::pair<Message, std::size_t>>, std::less<>> waiting_;
  std::deque<std::string> turns_;  // peers with waiting messages
  std::size_t messages_ = 0, bytes_ = 0;
  std::uint64_t ignored_ = 0;
};

}  // namespace dmise
