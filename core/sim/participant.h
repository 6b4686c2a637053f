#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/sim/message.h"
#include "core/sim/schedule.h"

namespace dmise {

/// An Actor or an Evaluator. It does not know whether it runs in one process under the
/// SimulationController or in a process of its own under nodes/runtime: both call `step` once for
/// each tick 0, 1, 2, ... last, in order.
class Participant {
 public:
  virtual ~Participant() = default;

  virtual std::string name() const = 0;
  virtual std::vector<std::string> produces() const = 0;  // topics, whole names
  virtual std::vector<std::string> consumes() const = 0;  // topics, whole names

  /// Whether it can't work without this topic: then it is lost with who publishes it. Otherwise,
  /// when a run goes on without that node, nothing comes on the topic any more.
  virtual bool needs(const std::string& topic) const {
    static_cast<void>(topic);
    return true;
  }

  /// The ticks at which it works; `step` is called for no other.
  virtual Schedule schedule() const { return {}; }

  /// The work of one tick. `inputs`: all messages of the consumed topics since the last step,
  /// ordered by (place of the topic in consumes(), order of publication). Returns what is
  /// published.
  virtual std::vector<Message> step(Tick tick, std::span<const Message> inputs) = 0;

  /// Ticks before the one at which it resumes whose inputs it needs to go on as if nothing had
  /// happened.
  virtual Tick look_back() const { return 0; }

  /// Takes up the work of an earlier process: the next `step` is that of `tick` or the first of its
  /// schedule after. `past`: what was consumed in the look_back() ticks before, and what was said
  /// once and for all. Returns what it has said once and for all itself (a roster), to be published
  /// again.
  virtual std::vector<Message> resume(Tick tick, std::span<const Message> past) {
    static_cast<void>(tick), static_cast<void>(past);
    return {};
  }

  /// How far the work of the current tick is, for the progress deadline: any number that grows.
  /// Called from another thread than `step`.
  virtual std::uint64_t progress() const { return 0; }
};

/// Has a state over time and tells it: platforms, Sun, Moon, Earth, skies. Asks nobody.
class Actor : public Participant {
 public:
  std::vector<std::string> consumes() const final { return {}; }
};

/// Asks for states and makes a product of them: images, tables, detections.
class Evaluator : public Participant {};

}  // namespace dmise
