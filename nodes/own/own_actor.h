#pragma once
#include <atomic>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/config/scenario.h"
#include "core/propagation/environment_source.h"
#include "core/sim/participant.h"
#include "core/time/clock.h"
#include "nodes/own/input_journal.h"
#include "nodes/own/own_node_run.h"

namespace dmise {

/// Publishes what a program of the user's says of the objects that it moves or turns. Starts the
/// program when its first step is due. Under `on_silent_node: restart` a program that dies or is
/// silent is started again, continues from its last checkpoint, and must say the same. What it
/// hears of others it hears late, and keeps in a journal, from which it can hear it again.
class OwnActor : public Participant {
 public:
  /// `scenario` must outlive it.
  OwnActor(const Scenario& scenario, const OwnNode& node, Clock clock, OwnNodeSettings settings);

  std::string name() const override { return node_.name; }
  std::vector<std::string> produces() const override;
  std::vector<std::string> consumes() const override { return node_.consumes; }
  /// A lost publisher is one that says nothing.
  bool needs(const std::string&) const override { return false; }
  Tick delay(const std::string&) const override { return node_.delay_ticks; }
  std::vector<Message> step(Tick tick, std::span<const Message> inputs) override;
  std::vector<Message> resume(Tick tick, std::span<const Message> past) override;
  std::uint64_t progress() const override { return steps_; }

 private:
  /// Hears the states of all calls up to this one that it has not; false after the stop.
  bool hear_up_to(Tick call);
  bool hear();
  /// Asks for the next calls, several at once, so that neither waits for the other at each tick.
  bool ask();
  v1::OwnNodeStep step_of(Tick call) const;
  void keep(Tick tick, std::span<const Message> inputs);
  /// Adds what the program hears with the next call.
  void add_heard(v1::OwnNodeStep& step);
  EnvironmentState environment_of(Tick call);
  void start();
  void check(const ObjectStates& states) const;
  void look_at_errors();
  void look_at_places(const ObjectStates& states, const EarthOrientation& earth);
  v1::OwnNodeBegin begin() const;
  const ObjectStates& states_of(Tick call) const;
  /// The ticks at one of which the program was lost or has ended: those that it was asked for.
  std::string lost_at() const;
  Tick tick_of(Tick call) const { return call * node_.period_ticks; }

  const Scenario& scenario_;
  OwnNode node_;
  EnvironmentByMinutes environment_;
  OwnNodeSettings settings_;
  std::vector<const OwnObject*> objects_;  // in the scenario's order
  std::vector<std::uint32_t> turned_;      // those that the node turns, by index
  std::unique_ptr<OwnModel> program_;
  OwnRecord said_;
  std::optional<InputJournal> journal_;  // if it consumes topics
  Tick kept_ = 0;                        // the first tick that is not in it
  std::optional<InputReader> heard_;     // at the next call
  std::deque<EnvironmentState> asked_;   // calls that the program knows of, the next first
  std::deque<ObjectStates> held_;        // states of the last calls
  OwnRestarts restarts_;
  std::vector<bool> warned_;       // objects that are not interpolated well
  std::vector<bool> underground_;  // those that were told to be
  std::atomic<std::uint64_t> steps_{0};
};

}  // namespace dmise
