#pragma once
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "core/products/kept_orbit.h"
#include "core/time/clock.h"
#include "core/tracking/maintenance/catalogue_object.h"

namespace dmise {

/// Orbits of objects, kept from one arc of their detections to the next by numerical forces: what a
/// fusion knows better than the element sets. An object is an index: of the catalogue, or beyond
/// it.
class KeptOrbits {
 public:
  /// Times between `first` and `last` are covered, at most 20 days.
  KeptOrbits(const Clock& clock, SimTime first, SimTime last);
  KeptOrbits(const KeptOrbits&) = delete;  // objects refer to its forces
  KeptOrbits& operator=(const KeptOrbits&) = delete;

  bool has(std::size_t object) const { return objects_.contains(object); }

  /// Where an object is, and the largest standard deviation of its position, for a coarse search.
  struct Place {
    OrbitState state;
    double sigma_m = 0.0, burnt_sigma_m = 0.0;  // as believed; after a manoeuvre that may have been
  };
  /// The places of all objects that have one, by rising object.
  std::vector<std::pair<std::size_t, Place>> places(SimTime time);
  Outcome<OrbitEstimate> estimate(std::size_t object, SimTime time);
  /// The estimate of an object that may have changed its velocity since its last arc, by some
  /// decimetres a second.
  Outcome<OrbitEstimate> burnt(std::size_t object, SimTime time);

  const MaintenanceForces& forces() const { return forces_; }
  /// The estimate at the begin of an object's window: when it was first seen, for a day or more.
  Outcome<OrbitEstimate> at_begin(std::size_t object) const {
    const CatalogueObject& kept = objects_.at(object).object;
    return kept.estimate_at(kept.begin());
  }

  /// Takes an arc of detections, in any order. `prior`: what is believed of an object that is not
  /// kept yet, before the arc. Detections before the last that were taken are left out. Refuses an
  /// arc without others, and a prior without a path.
  Outcome<KeptOrbit> take(std::size_t object, const OrbitEstimate& prior,
                          std::vector<AngleObservation> arc);

  /// The kept object whose orbit, or a manoeuvre since its last arc, explains this one without
  /// outliers; `seen`: about where the arc's object is. Only objects that `may_be` are tried.
  std::optional<std::size_t> owner_of(const OrbitState& seen, std::vector<AngleObservation> arc,
                                      const std::function<bool(std::size_t)>& may_be);

 private:
  struct Sigmas {
    double sigma_m = 0.0, burnt_sigma_m = 0.0;
  };
  struct Kept {
    CatalogueObject object;
    std::uint32_t arcs = 0;
    std::optional<OrbitEstimate> last = {};  // after the last arc
    std::optional<ArcPath> ahead = {};       // from there
    std::vector<Sigmas> sigmas = {};         // along it, every sigma_step_s
  };
  std::optional<Place> place(std::size_t object, SimTime time);
  bool look_ahead(Kept& kept, SimTime to);

  SimTime last_;
  MaintenanceForces forces_;
  std::map<std::size_t, Kept> objects_;
};

/// An estimate whose scales of drag and sunlight are those of most satellites, to a factor of two.
OrbitEstimate with_usual_scales(OrbitEstimate estimate);

}  // namespace dmise
