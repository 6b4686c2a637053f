#pragma once
#include "core/base/parallel.h"
#include "core/orbit/sgp4_batch.h"
#include "orbit-node/object_population.h"

namespace dmise {

/// States of a population at any time, in GCRS, all motion models behind one call.
class StateSource {
 public:
  /// `population` must outlive it.
  StateSource(const ObjectPopulation& population, Clock clock, Threads& threads);

  /// Slopes are symmetric differences of SGP4 over `slope_half_step_s`, the exact slope of the path
  /// for the other models. A function of `time` alone.
  ObjectStates at(Tick tick, SimTime time) const;

  /// Why object `i` has no state: one line that names it and, of a trajectory, the span.
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
