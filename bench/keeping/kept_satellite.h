#pragma once
#include <string>
#include <vector>

#include "core/fusion/pass_association.h"
#include "core/tracking/maintenance/catalogue_object.h"
#include "tests/support/known_satellite.h"
#include "tests/support/watched_crowd.h"
#include "tests/support/watched_orbit.h"

namespace dmise {

/// A satellite whose days from `start` have a precise orbit.
struct SatelliteDays {
  const char* name;
  const char* logged;
  const char* start;
  int days;
};

/// Its days, with the places where watchers look.
struct WatchedSatellite {
  SatelliteDays of;
  KnownSatellite satellite;
  MaintenanceForces forces;
  std::vector<MotionState<Gcrs>> places;

  WatchedSatellite(const std::string& data, const SatelliteDays& days,
                   const MaintenanceSettings& settings = {});
  SimTime at_day(double day) const;
  const MotionState<Gcrs>& place(SimTime t) const;
  OrbitState truth(SimTime t) const;
  DiffuseSphere sphere() const;
  OrbitEstimate believed_at(SimTime t, double age_days) const;
  WatchedOrbit watched() const;
  /// Other objects of a catalogue.
  WatchedCrowd crowd(std::vector<MeanElements> elements) const;
};

/// Errors of estimates beside the truth.
struct OrbitErrors {
  double squares_m2 = 0, nees = 0, worst_m = 0;
  int count = 0;

  void add(const Outcome<OrbitEstimate>& estimate, const OrbitState& truth);
  void add(const OrbitErrors& other);
  double rms_m() const;
  double mean_nees() const { return nees / count; }
};

/// What associations did of an object's passes.
struct AssociationTally {
  std::size_t own = 0;     // detections of the object
  std::size_t others = 0;  // detections of other objects
  std::size_t exposures = 0;
  std::size_t right = 0, wrong = 0, ambiguous = 0;

  void add(const AssociationTally& other);
};

/// An object that is kept by passes, and what that tells.
struct KeptSatellite {
  CatalogueObject object;
  std::vector<FoundManoeuvre> found = {};
  std::size_t detections = 0, passes = 0;
  AssociationTally tally = {};

  /// Passes between two times.
  void feed(const std::vector<std::vector<AngleObservation>>& all, SimTime from, SimTime to);
  /// Here each pass is first to be found among other objects.
  void feed(const MaintenanceForces& forces, const std::vector<std::vector<PassExposure>>& all,
            SimTime from, SimTime to, const PassAssociationSettings& settings = {});

 private:
  void take(const std::vector<AngleObservation>& pass);
};

}  // namespace dmise
