#pragma once
#include <random>
#include <string>
#include <vector>

#include "core/sim/message.h"
#include "nodes/wire/receiver.h"

// One state of each kind with every field set, and the run that they belong to.
namespace dmise::test {

inline RunFacts example_run() {
  return {.run_id = 0x1234567890abcdef, .tick_length = {5'000'000'000}, .last_tick = 24};
}

/// Numbers with all their bits in use, in [low, high].
class Numbers {
 public:
  explicit Numbers(unsigned seed) : engine_(seed) {}
  double in(double low, double high) {
    return low + (high - low) * (double(engine_() >> 11) * 0x1p-53);
  }
  template <class F>
  Vec<F> vec(double limit) {
    return {in(-limit, limit), in(-limit, limit), in(-limit, limit)};
  }
  std::mt19937_64& engine() { return engine_; }

 private:
  std::mt19937_64 engine_;
};

struct Example {
  std::string topic;
  Tick tick = 0;
  State state;
};

/// A state of every kind, with numbers that differ with `seed`.
std::vector<Example> examples(unsigned seed);

/// The envelope in which "source" sends the example.
Envelope envelope_of(const Example& example, MessageKind kind, std::uint64_t sequence = 1);

/// The example as it is sent by the node "source".
Frames sealed(const Example& example, std::uint64_t sequence = 1);

/// A receiver that accepts every topic of the examples from "source".
Receiver receiver_of_examples();

}  // namespace dmise::test
