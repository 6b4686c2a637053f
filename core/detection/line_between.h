#pragma once
#include <array>
#include <cmath>
#include <vector>

#include "core/detection/end_errors.h"
#include "core/detection/scene.h"

// Likelihood of a line of light between any two places on it.
namespace dmise {

/// Sums over pixels whose light is on one side of an end, blurred by the PSF: of their light, of
/// their weights times the share that is there, and of those times its square; each times 1, k and
/// k^2 of the place k along the line.
struct Beyond {
  double along_px = 0.0, width_px = 0.0;  // the end, and of how many px it is the only one
  std::array<double, 2> light{};
  std::array<double, 3> weight{}, square{};
};

/// Of ends on a trail's line, from `beyond_px` before the trail to as much behind it, or to the
/// frame's edge: every half px close to the trail's ends, by an eighth of the distance farther
/// away. Pixels are those that a fit uses. Empty if there are hardly any.
std::vector<Beyond> ends_along(const Scene& scene, const Trail& trail, double beyond_px);

/// A line of light between two ends: its likelihood, and its light with its errors.
class LineBetween {
 public:
  /// `sloped`: its brightness may change from end to end, by as much as is even between -1 and 1.
  LineBetween(const Beyond& first, const Beyond& last, bool sloped);

  double middle_px() const { return middle_px_; }
  double length_px() const { return length_px_; }
  double flux_e() const { return level_ * length_px_; }
  /// Logarithm of its probability by the place of both ends, if ends, light, and offset and
  /// direction of the line may be anything; -infinity: it is dark. Light of an SNR on a length
  /// leaves offset and direction free by 1 / (SNR^2 length), and length times level is the light.
  double log_odds() const { return log_odds_; }
  /// Adds `likely` times the products of its differences from a trail, from which its line is
  /// turned.
  void add_to(EndErrors& errors, const Trail& trail, double turn_rad, double likely) const;

 private:
  double middle_px_, length_px_;
  double log_odds_ = -HUGE_VAL;
  double level_ = 0.0, slope_ = 0.0;                // electrons per px, relative
  double level2_ = 0.0, both_ = 0.0, tilt2_ = 0.0;  // covariance of level and slope times level
};

}  // namespace dmise
