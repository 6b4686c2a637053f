#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/sim/message.h"
#include "core/sim/schedule.h"

namespace dmise {

/// An actor or an evaluator. Both the SimulationController, in one process, and nodes/runtime, in a
/// process per participant, call `step` once for each tick 0, 1, 2, ... last, in order.
class Participant {
 public:
  virtual ~Participant() = default;

  virtual std::string name() const = 0;
  virtual std::vector<std::string> produces() const = 0;  // full topic names
  virtual std::vector<std::string> consumes() const = 0;  // full topic names

  /// Whether it cannot work without this topic: it is then lost together with the publisher.
  /// Otherwise the topic falls silent if the run continues without the publisher.
  virtual bool needs(const std::string& /*topic*/) const { return true; }

  /// Ticks by which it hears a consumed topic late: at tick k it is given what was published up to
  /// k - delay. A loop of topics needs one with a delay. A participant that continues a run is
  /// given what was published in the last `delay` ticks before again; what is older it must have
  /// kept.
  virtual Tick delay(const std::string& /*topic*/) const { return 0; }

  /// The ticks at which it works; `step` is called for no other tick.
  virtual Schedule schedule() const { return {}; }
  /// The ticks, of `schedule`, at which it may publish on one of its topics; consumers wait for it
  /// at no others. The look-back of each consumer must reach the last of them.
  virtual Schedule schedule_of(const std::string& /*topic*/) const { return schedule(); }

  /// Performs the work of one tick. `inputs`: all messages of the consumed topics since the last
  /// step, ordered by (index of the topic in consumes(), order of publication). Returns the
  /// messages to publish.
  virtual std::vector<Message> step(Tick tick, std::span<const Message> inputs) = 0;

  /// Number of ticks before the one at which it resumes whose inputs it needs.
  virtual Tick look_back() const { return 0; }

  /// Continues the work of an earlier process: the next `step` is that of `tick` or the first of
  /// its schedule after. `past`: inputs of the look_back() ticks before, and retained messages.
  /// Returns its own retained messages (a roster), to be published again.
  virtual std::vector<Message> resume(Tick /*tick*/, std::span<const Message> /*past*/) {
    return {};
  }

  /// Progress within the current tick, for the progress deadline: any increasing number. Called
  /// from another thread than `step`.
  virtual std::uint64_t progress() const { return 0; }
};

/// Has a state that evolves in time and publishes it: platforms, Sun, Moon, Earth, skies. Consumes
/// no topics.
class Actor : public Participant {
 public:
  std::vector<std::string> consumes() const final { return {}; }
};

/// Consumes states and makes products: images, tables, detections.
class Evaluator : public Participant {};

}  // namespace dmise
