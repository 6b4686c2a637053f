#pragma once
#include "core/config/scenario.h"
#include "core/effects/plan_facts.h"
#include "core/optics/psf_plan.h"
#include "core/optics/range_defocus.h"

namespace dmise {

/// What is known of the focus of objects before an exposure is made.
class DefocusFacts {
 public:
  DefocusFacts(const SensorConfig& sensor, SimTime middle);

  /// Adds an object to the facts. Returns by how much its blur, with the pixel, is wider than that
  /// of stars.
  double add(double range_m, double trail_px, PlanFacts& f) const;

 private:
  const Optics& optics_;
  PsfPlan plan_;
  Optics blurred_;
  DefocusScale scale_;
  double in_focus_m_;
};

}  // namespace dmise
