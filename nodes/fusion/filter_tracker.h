#pragma once
#include <map>
#include <string>

#include "core/config/scenario.h"
#include "core/time/clock.h"
#include "nodes/fusion/tracker.h"

namespace dmise {

/// Makes tracks by the filters of core/fusion.
class FilterTracker : public Tracker {
 public:
  /// `known`: objects with elements that it knows beforehand.
  FilterTracker(const Scenario& scenario, const ObjectRoster& known, const Clock& clock);

  std::optional<Tracked> step(Tick tick, std::span<const SearchedFrame> frames) override;
  std::vector<CueTarget> targets(SimTime time) const override { return fusion_.targets(time); }

 private:
  struct Camera {
    int columns = 0, rows = 0;
    double half_angle_rad = 0.0;
  };
  std::map<std::string, Camera> cameras_;
  SimTime tick_length_;
  double pointing_sigma_rad_;
  Fusion fusion_;
};

}  // namespace dmise
