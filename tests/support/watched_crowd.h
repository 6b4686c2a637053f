#pragma once
#include <memory>
#include <vector>

#include "core/fusion/catalogue_prediction.h"
#include "core/fusion/pass_association.h"
#include "tests/support/watched_orbit.h"

namespace dmise {

/// Objects of a catalogue beside one that is watched: the same exposures detect them, too. Their
/// paths are those of SGP4; what is believed of them is off by the errors of their element sets.
class WatchedCrowd {
 public:
  /// Element sets as if the newest had been made at the clock's start. `sphere`: all are as bright
  /// as the object itself, which is more than most are.
  WatchedCrowd(std::vector<MeanElements> elements, const Clock& clock, const DiffuseSphere& sphere);

  std::size_t size() const { return paths_.size(); }

  /// The exposures of an object's passes with all that they detect within 10 deg of it, and with
  /// what is believed of the others there.
  std::vector<std::vector<PassExposure>> passes(const std::vector<WatchedExposure>& exposures,
                                                const WatchedOrbit::Draw& draw);

 private:
  struct Instant;
  void add_others(const WatchedExposure& exposure, const Instant& now,
                  const WatchedOrbit::Draw& draw, PassExposure& out) const;
  OrbitEstimate believed(std::size_t i, std::uint64_t seed) const;

  Clock clock_;
  DiffuseSphere sphere_;
  CataloguePrediction paths_;
};

}  // namespace dmise
