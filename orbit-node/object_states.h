#pragma once
#include "core/base/parallel.h"
#include "core/orbit/sgp4_batch.h"
#include "orbit-node/object_population.h"

namespace dmise {

/// States of a population at any time, in GCRS, for all motion models.
class StateSource {
 public:
  /// `population` must outlive it.
  StateSource(const ObjectPopulation& population, Clock clock, Threads& threads);

  /// Slopes are symmetric differences of SGP4 over `slope_half_step_s`, and exact for the other
  /// models. Depends on `time` alone.
  ObjectStates at(Tick tick, SimTime time) const;

  /// Returns why object `i` has no state: one line that names it and the span of a trajectory.
  std::string why_absent(std::size_t i, const ObjectStates& states) const;

 private:
  struct Instant;
  void add_sgp4(const Instant (&instants)[3], ObjectStates& states) const;
  void add_models(const Instant& now, ObjectStates& states) const;
  void add_attitudes(const Instant (&instants)[3], ObjectStates& states) const;

  const ObjectPopulation& population_;
  Clock clock_;
  Threads& threads_;
  Sgp4Batch batch_;
};

}  // namespace dmise
