#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/base/sim_time.h"
#include "core/frames/vec.h"
#include "core/orbit/attitude_interpolation.h"
#include "core/sim/message.h"
#include "core/sim/state.h"

// Models of one's own in a run, in C++ (docs/howto/plug-in-a-model.md):
//
//   struct Orbit {
//     dmise::ObjectState step(const dmise::ActorWorld& world);
//   };
//   int main(int argc, char** argv) { return dmise::node_main<Orbit>(argc, argv); }
namespace dmise {

/// State of one object at a tick, in GCRS.
struct ObjectState {
  Vec<Gcrs> position_m;                         // set for an object that the node moves
  Vec<Gcrs> velocity_m_per_s;                   // the model's
  std::optional<Vec<Gcrs>> slope_m_per_s = {};  // derivative of the position, if another
  std::optional<AttitudeState> attitude = {};   // set for an object that the node turns
  std::optional<double> albedo = {};            // instead of the scenario's, of one that it moves
};

/// States in the order of `ActorTask::objects`. An object without one is not in the scene.
using ObjectStateList = std::vector<std::optional<ObjectState>>;

/// What an actor is told as it begins.
struct ActorTask {
  std::string node;
  std::vector<std::string> objects;  // those that it moves or turns
  nlohmann::json options;            // an object, as the scenario has it
  std::string start_utc;             // start of the scenario
  std::uint64_t seed = 0;            // seed of the scenario
  SimTime tick;                      // length of one
  Tick last_tick = 0;                // last one of the run
  Tick period_ticks = 1;             // between two steps

  /// An option that is a number, or three. Throw `Error` "option KEY: reason" if it is not there or
  /// something else.
  double number(const std::string& option) const;
  Vec<Gcrs> vector(const std::string& option) const;
};

/// What an actor is told with a tick.
struct ActorWorld {
  const ActorTask& task;
  Tick tick = 0;
  SimTime time;                  // since the scenario's start
  EnvironmentState environment;  // Sun, Moon and Earth at the tick
  std::vector<Message> heard;    // on the topics that the node consumes, since the last tick
};

/// A model of the user's, whatever its type.
class ActorModel {
 public:
  virtual ~ActorModel() = default;
  virtual ObjectStateList step(const ActorWorld& world) = 0;
  /// Nothing, if the model has no checkpoints.
  virtual std::optional<std::string> checkpoint() = 0;
  /// Throws `Error` if the model has no checkpoints.
  virtual void restore(std::string_view checkpoint) = 0;
};
using MakeActor = std::function<std::unique_ptr<ActorModel>(const ActorTask&)>;

/// Says what a model says, tick by tick, to the run that has started this program, until the run
/// ends. Returns the program's exit code: 0, or 1 after a line on stderr that begins with
/// `program`. What the model throws is the reason with which the run fails.
int serve_actor(const MakeActor& make, const std::string& program);

[[noreturn]] void refuse_checkpoint();

template <class T>
class ActorModelOf : public ActorModel {
 public:
  explicit ActorModelOf(const ActorTask& task) : model_(made(task)) {}

  ObjectStateList step(const ActorWorld& world) override { return listed(model_.step(world)); }
  std::optional<std::string> checkpoint() override {
    if constexpr (requires { model_.checkpoint(); }) return model_.checkpoint();
    return std::nullopt;
  }
  void restore(std::string_view checkpoint) override {
    if constexpr (requires { model_.restore(checkpoint); })
      model_.restore(checkpoint);
    else
      refuse_checkpoint();
  }

 private:
  static T made(const ActorTask& task) {
    if constexpr (std::is_constructible_v<T, const ActorTask&>)
      return T(task);
    else
      return T();
  }
  static ObjectStateList listed(std::optional<ObjectState> only) { return {std::move(only)}; }
  static ObjectStateList listed(ObjectStateList states) { return states; }
  static ObjectStateList listed(const std::vector<ObjectState>& states) {
    return {states.begin(), states.end()};
  }

  T model_;
};

/// The `main` of a program that moves or turns objects by a model `T`. `T::step(const ActorWorld&)`
/// is called for each tick in order. It returns an `ObjectState` or an `optional` of one where the
/// node has one object, a `vector` of either where it has several. `T` is made of the `ActorTask`
/// if it can be, else without arguments. If it has `std::string checkpoint()` and
/// `void restore(std::string_view)`, a program that was killed continues from its last checkpoint,
/// else it is run again from tick 0. Its states must be the same in each run.
template <class T>
int node_main(int, char** argv) {
  return serve_actor([](const ActorTask& task) { return std::make_unique<ActorModelOf<T>>(task); },
                     argv[0]);
}

}  // namespace dmise
