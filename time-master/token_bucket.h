#pragma once
#include <algorithm>
#include <map>
#include <string>
#include <string_view>

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

}  // namespace dmise
