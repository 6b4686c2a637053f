#pragma once
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/detection/source/end_errors.h"
#include "core/detection/source/scene.h"

// Likelihood of a line of light between any two places on it.
namespace dmise {

/// Sums over the pixels beyond an end, of each by the share s of its light that is there, as the
/// end is blurred by the PSF: of light times s, weight times s and weight times s^2; each times 1,
/// k and k^2 of the place k along the line.
struct Beyond {
  double along_px = 0.0, width_px = 0.0;  // the end, and the length for which it stands
  std::array<double, 2> light{};
  std::array<double, 3> weight{}, square{};
};

/// Returns possible ends on a trail's line, from `beyond_px` before the trail to as far behind it,
/// within the frame and what is measured of it: every half px near the trail's ends, farther away
/// in steps of an eighth of the distance from them. Uses the pixels that a fit uses; empty if there
/// are fewer than 3.
std::vector<Beyond> ends_along(const Scene& scene, const Trail& trail, double beyond_px);

/// A line of light between two ends: its likelihood, and its light with its errors.
class LineBetween {
 public:
  /// `sloped`: its brightness may change from end to end, by a slope that is uniform in -1..1.
  LineBetween(const Beyond& first, const Beyond& last, bool sloped);

  double middle_px() const { return middle_px_; }
  double length_px() const { return length_px_; }
  double flux_e() const { return level_ * length_px_; }
  /// Logarithm of the probability density of both ends, where all ends, light, offsets and
  /// directions of the line are equally likely; -infinity if there is no light. Offset and
  /// direction are free by 1 / (SNR^2 length), and the light is length times level.
  double log_odds() const { return 0.5 * gain_ - 0.5 * std::log(volume_); }
  /// Whether they may be above some odds: false is sure, without a logarithm.
  bool may_exceed(double odds) const {
    constexpr double ln2 = 0.6931471805599453, rounding = 1e-9, min_volume = 1e-300;
    if (!(volume_ > min_volume)) return true;
    // At least the logarithm to 2 of a number is its exponent plus its fraction.
    const auto word = std::bit_cast<std::uint64_t>(volume_);
    const double lower = double(std::int64_t(word)) * 0x1p-52 - 1023.0;
    const double upper = 0.5 * gain_ - 0.5 * ln2 * lower;
    return !(upper + rounding * (std::abs(upper) + std::abs(gain_)) + rounding < odds);
  }
  /// Adds `likely` times the products of its differences from a trail, from which its line is
  /// turned by `turn_rad`.
  void add_to(EndErrors& errors, const Trail& trail, double turn_rad, double likely) const;

 private:
  double middle_px_, length_px_;
  double gain_ = -HUGE_VAL, volume_ = 1.0;          // log_odds is half of the gain less log(volume)
  double level_ = 0.0, slope_ = 0.0;                // electrons per px, relative
  double level2_ = 0.0, both_ = 0.0, tilt2_ = 0.0;  // covariance of level and slope times level
};

}  // namespace dmise
