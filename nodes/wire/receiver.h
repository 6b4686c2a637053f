#pragma once
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/sim/message.h"
#include "nodes/wire/envelope.h"

namespace dmise {

/// Parameters that every message of a run must match.
struct RunFacts {
  std::uint64_t run_id = 0;
  SimTime tick_length{1};
  Tick last_tick = 0;

  SimTime time_of(Tick tick) const { return {tick * tick_length.ns}; }
  bool operator==(const RunFacts&) const = default;
};

/// A message that passed every check. `state` is empty in probes, watermarks and positions.
struct Received {
  std::string topic;
  Envelope envelope;
  std::shared_ptr<const State> state;
  std::uint64_t content_digest = 0;  // digest of kind, payload and arrays
};

/// Validates received messages for every subscription. Messages that fail a check are counted by
/// reason and dropped.
class Receiver {
 public:
  explicit Receiver(RunFacts run) : run_(run) {}

  /// Accepts messages on `topic` only from this publisher.
  void allow(const std::string& topic, const std::string& publisher, std::uint64_t incarnation);

  /// Empty if the message is refused.
  std::optional<Received> receive(std::span<const std::string_view> frames);

  std::uint64_t refused(Refusal reason) const { return refused_[std::size_t(reason)]; }
  std::uint64_t refused() const;
  /// Reason of the last refusal; empty if there was none.
  const std::string& last_refusal() const { return last_refusal_; }

 private:
  struct Source {
    std::string publisher;
    std::uint64_t incarnation = 0;
  };
  Received accept(std::span<const std::string_view> frames) const;

  RunFacts run_;
  std::map<std::string, Source, std::less<>> sources_;
  std::array<std::uint64_t, std::size_t(Refusal::count)> refused_{};
  std::string last_refusal_;
};

}  // namespace dmise
