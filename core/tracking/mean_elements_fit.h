#pragma once
#include "core/forces/forces.h"
#include "core/orbit/elements/elements.h"
#include "core/time/clock.h"
#include "core/tracking/orbit_state.h"
#include "core/tracking/outcome.h"

namespace dmise {

/// Elements of SGP4, and how far its path is from the one that they stand for.
struct MeanElementsFit {
  MeanElements elements;
  double rms_m = 0.0;    // distances at the nodes of the fit
  double worst_m = 0.0;  // largest of them
};

/// Elements whose SGP4 path is nearest to that of `state` under `forces`, by least squares over 25
/// places of one revolution around it, of a day at most. B* is that of the drag of
/// `state`, 12.741621 B* = Cd A / m (Vallado, Fundamentals of Astrodynamics, section 9.4.2). The
/// epoch is the time of `state`; number, name and designator are left empty. Near the Earth rms_m
/// is some hundred metres: SGP4 has no tesserals, and rounds its theory off. Refuses an orbit that
/// is open, enters the Earth or is beyond SGP4.
Outcome<MeanElementsFit> fit_mean_elements(const Clock& clock, const ForceModel& forces,
                                           const OrbitState& state);

}  // namespace dmise
