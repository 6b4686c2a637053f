#pragma once
#include <span>
#include <vector>

#include "core/fusion/fusion.h"
#include "core/orbit/cones/cone_test.h"
#include "core/sky/bodies/shadow.h"

namespace dmise {

/// What may be seen by a frame: a track, or a catalogued object without one.
struct Fusion::Candidate {
  LiveTrack* track = nullptr;
  std::size_t object = 0;  // without a track
  bool burnt = false;      // a kept object as it may be after a manoeuvre
  Vec<Gcrs> direction;     // about, unit
  double range_m = 0.0;    // about
  double radius_rad = 0.0;
  double sigma_rad = 0.0;
};

/// What frames of about one time share.
struct Fusion::Scene {
  Scene(const Clock& clock, const CataloguePrediction& catalogue, const Ellipsoid& ellipsoid);

  /// For each frame a row of bits: catalogued objects that may be in its field.
  std::vector<std::uint64_t> objects_in(std::span<const SensorFrame> frames,
                                        const CataloguePrediction& catalogue) const;
  /// Fraction of the Sun's disc that shines on a place.
  double sunlit(const Vec<Gcrs>& position_m) const;

  /// Whether an object is expected where its kept orbit has it.
  bool is_kept(std::size_t object) const;

  SimTime time;
  EarthShadow shadow;
  std::vector<LiveTrack*> placed;                               // tracks with a rough place
  std::vector<LooseSource> loose;                               // what no track took
  std::vector<std::pair<std::size_t, KeptOrbits::Place>> kept;  // kept objects, and where they are
};

}  // namespace dmise
