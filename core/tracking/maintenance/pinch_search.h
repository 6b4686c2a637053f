#pragma once
#include <map>
#include <optional>
#include <vector>

#include "core/tracking/maintenance/arc_path.h"

namespace dmise {

/// A point through which several objects passed at one time: where one broke up, or let others go.
struct PinchPoint {
  SimTime time;
  double time_sigma_s = 0.0;
  Vec<Gcrs> position_m;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // errors of the place, at `time` [m^2]
  Vec<Gcrs> velocity_m_per_s;                            // mean of the members'
  std::vector<std::size_t> members;                      // rising
  double chi_square = 0.0;                               // by the members' places about one point
  int degrees = 0;
  double confidence = 0.0;  // that neither chance nor another time explains it, [0, 1]
};

struct PinchSettings {
  double back_s = 86400.0;            // how long before an object was first seen
  double max_sigma_m = 40e3;          // where a place is known worse, nothing is looked at
  double max_apart_m_per_s = 1500.0;  // between two members
  double max_time_sigma_s = 600.0;    // objects that stay together have no such time
  std::size_t min_members = 3;
  double min_confidence = 0.99;
};

/// Looks for points from which objects came, by where each was before it was first seen.
class PinchSearch {
 public:
  /// Nothing is looked for before `first`, at which times of `forces` begin. `forces` must live as
  /// long.
  PinchSearch(const MaintenanceForces& forces, SimTime first, const PinchSettings& settings = {});

  /// Takes an object, or better knowledge of one: its estimate when it was first seen. One without
  /// a path before that is left out, as is what is of a later time than what is known.
  void put(std::size_t object, const OrbitEstimate& first_seen);

  /// The likeliest point from which an object and two or more others came.
  std::optional<PinchPoint> of(std::size_t object) const;

 private:
  struct Past {
    ArcPath path;                        // back from when it was first seen
    OrbitMatrix covariance;              // then
    long first = 0;                      // number of the earliest place in the grid of times
    std::vector<Vec<Gcrs>> places = {};  // every grid step from there
    std::vector<double> sigmas = {};     // deviation of each place [m]
  };
  struct Meeting {
    std::size_t other = 0;
    double time_s = 0.0;
  };
  std::vector<Meeting> meetings(const Past& past, std::size_t object) const;
  std::vector<std::size_t> near(const Past& past, double time_s) const;
  std::optional<PinchPoint> solved(std::vector<std::size_t> members, SimTime time) const;
  double expected_by_chance(const PinchPoint& point) const;

  const MaintenanceForces* forces_;
  SimTime first_;
  PinchSettings settings_;
  std::map<std::size_t, Past> pasts_;
};

}  // namespace dmise
