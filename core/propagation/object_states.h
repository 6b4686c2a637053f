#pragma once
#include <array>
#include <span>

#include "core/base/parallel.h"
#include "core/orbit/sgp4/sgp4_batch.h"
#include "core/propagation/actor_states.h"
#include "core/propagation/object_population.h"
#include "core/time/clock.h"

namespace dmise {

/// A time with those inputs of the motion models that do not depend on the object.
struct StateInstant {
  SimTime time;
  Tai tai;
  Utc utc;
  EarthOrientation earth;
  Rotation<Gcrs, Teme> gcrs_from_teme;
};

/// Half a step of the slope (`slope_half_step_ns`) before a time, the time, and half a step after.
using StateInstants = std::array<StateInstant, 3>;

/// States of a population at any time, in GCRS, for all motion models.
class StateSource {
 public:
  /// `population` must outlive it.
  StateSource(const ObjectPopulation& population, Clock clock, Threads& threads);

  /// Slopes are symmetric differences of SGP4 over twice `slope_half_step_ns`, and exact for the
  /// other models. The states depend on `time` alone.
  /// What a node moves or turns is as `told`; without what it says it has no state.
  ObjectStates at(Tick tick, SimTime time, const ActorStates* told = nullptr) const;

  /// States of `objects`, ascending indices: equal to those of `at` to the bit. Object k of the
  /// result is `objects[k]`, also in `attitude_object`.
  ObjectStates of_some(std::span<const std::uint32_t> objects, Tick tick,
                       const StateInstants& instants, const ActorStates* told = nullptr) const;
  /// `known`: orientations that need not be computed.
  StateInstants instants(SimTime time, std::span<const EarthOrientation> known = {}) const;

  /// Returns why object `i` has no state: one line that names it and the span of a trajectory.
  std::string why_absent(std::size_t i, const ObjectStates& states) const;

  const ObjectPopulation& population() const { return population_; }
  const Clock& clock() const { return clock_; }
  /// Propagates the first `size()` objects of the population.
  const Sgp4Batch& elements() const { return batch_; }

 private:
  struct Scene;
  ObjectStates states_of(const Scene& scene) const;
  void add_sgp4(const Scene& scene, ObjectStates& states) const;
  void add_models(const Scene& scene, ObjectStates& states) const;
  void add_attitudes(const Scene& scene, ObjectStates& states) const;

  const ObjectPopulation& population_;
  Clock clock_;
  Threads& threads_;
  Sgp4Batch batch_;
};

}  // namespace dmise
