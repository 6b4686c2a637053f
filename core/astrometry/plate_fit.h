#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/astrometry/plate_model.h"

namespace dmise {

/// An image of a star: measured pixel with its covariance, and the apparent direction.
struct PlateMatch {
  std::uint32_t source = 0, star = 0;  // places in the lists that were matched
  PixelPosition pixel;
  std::array<double, 3> covariance_px2{};  // var x, cov xy, var y
  Vec<Gcrs> direction;                     // unit
  bool ignored = false;                    // by the fit: its place is not to be relied on
};

/// What a fit of a plate leaves free besides the attitude.
struct PlateFreedom {
  bool focal_length = false;
  bool centre = false;
  int order = 0;        // order of the distortion
  bool radial = false;  // with order 0: the one term that is symmetric about the axis

  int size() const { return 3 + focal_length + 2 * centre + radial + distortion_size(order); }
  bool operator==(const PlateFreedom&) const = default;
};

/// A plate fitted to matches, with the covariance of what was free, in this order: rotation vector
/// on the camera's axes [rad], relative focal length, centre [px], distortion [px].
struct PlateFit {
  PlateModel model;
  PlateFreedom free;
  std::vector<double> covariance;  // free.size() squared
  std::vector<char> used;          // by matches: whether it is no outlier
  int count = 0;                   // matches used
  double chi2 = 0.0;               // by the stated covariances of these
  double rms_px = 0.0;             // residual distance of these
  /// Residuals over what the stated covariances expect, >= 1; the covariance holds its square.
  double error_scale = 1.0;

  double variance(int i) const { return covariance[std::size_t(i * (free.size() + 1))]; }
  /// Standard deviation of the fitted place of a direction along one axis [px]: the mean of both.
  double sigma_px(const Vec<Gcrs>& direction, PixelPosition pixel) const;
};

struct PlateFitSettings {
  double min_sigma_px = 0.0;    // error of the stars' places, added to the matches'
  double outlier_sigmas = 4.5;  // in the plane
};

/// Fits a plate by least squares without outliers, starting from `model`. Empty if there are fewer
/// measurements than unknowns or they don't determine them.
std::optional<PlateFit> fit_plate(const PlateModel& model, std::span<const PlateMatch> matches,
                                  const PlateFreedom& free, const PlateFitSettings& settings = {});

}  // namespace dmise
