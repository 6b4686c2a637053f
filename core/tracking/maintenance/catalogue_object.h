#pragma once
#include <optional>
#include <span>
#include <vector>

#include "core/tracking/maintenance/manoeuvre_modes.h"

namespace dmise {

/// A manoeuvre that the observations of an object show.
struct FoundManoeuvre {
  SimTime found;  // time of the observation by which it was found
  // The likeliest mode, with the spread of all about it.
  VelocityChange change;
  double time_sigma_s = 0.0;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // [m^2/s^2]
  std::vector<ManoeuvreMode> modes = {};                 // all, the likeliest first
  double gain = 0.0;                                     // by which it lowers the sum of squares
  double confidence = 0.0;  // probability that noise would not have shown it, [0, 1]
};

/// What an arc of observations told of an object.
struct ArcNews {
  double innovation_d2 = 0.0;  // chi-square of `degrees` by the whole arc, if nothing happened
  int degrees = 0;
  double residual_d2 = 0.0;  // chi-square of the arc by the orbit that has taken it
  std::size_t outliers = 0;  // observations that were left out
  std::optional<FoundManoeuvre> manoeuvre;
};

/// The orbit of a catalogued object, kept from arc to arc of its observations.
class CatalogueObject {
 public:
  /// `prior`: what was believed at a time, such as of an element set. `forces` must live as long.
  CatalogueObject(const MaintenanceForces& forces, const OrbitEstimate& prior);

  /// Takes the observations of one pass, in order of time, none before the last. If they don't fit,
  /// looks for a manoeuvre since the window began, and goes on from it. Refuses an arc that is
  /// early or without a path, and stays as it was.
  Outcome<ArcNews> take(const std::vector<AngleObservation>& arc);

  SimTime time() const;                                // the last observation's, or the prior's
  SimTime begin() const { return prior_.state.time; }  // when the window begins
  Outcome<OrbitEstimate> estimate_at(SimTime time) const;
  /// All manoeuvres so far, by the time at which they were found. The latest are estimated anew by
  /// each arc.
  const std::vector<FoundManoeuvre>& manoeuvres() const { return manoeuvres_; }
  /// Those that the last arc has estimated.
  std::span<const FoundManoeuvre> open_manoeuvres() const {
    return std::span(manoeuvres_).subspan(first_fitted_);
  }

 private:
  bool is_settled() const;
  /// Looks for a manoeuvre that `before`, the fit with the orbit of the last arc, shows better than
  /// `fit`, which has none; if there is one, `fit` has it then.
  std::optional<FoundManoeuvre> search(const ArcFit& before, ArcFit& fit) const;
  /// Moves a manoeuvre to its likeliest time. Fills what is known of it.
  void place(ArcFit& fit, std::size_t k, FoundManoeuvre& known) const;
  Outcome<ArcFit> with_arc(const std::vector<AngleObservation>& arc) const;
  std::size_t leave_outliers_out(ArcFit& fit, SimTime since) const;
  void keep(ArcFit&& fit);
  void slide();

  const MaintenanceForces* forces_;
  OrbitEstimate prior_;
  Eigen::Vector2d scale_variances_;   // prior variances of drag and sunlight
  std::optional<ArcFit> fit_;         // none before the first arc
  std::vector<OrbitEstimate> after_;  // the arcs of the window
  int arcs_ = 0;
  std::vector<FoundManoeuvre> manoeuvres_;
  std::size_t first_fitted_ = 0;  // manoeuvres_ from it on are unknowns of the fit
};

}  // namespace dmise
