#pragma once
#include <cmath>
#include <optional>

#include "core/astrometry/plate_match.h"
#include "core/astrometry/star_sources.h"
#include "core/base/algebra/symmetric2.h"
#include "core/base/image.h"
#include "core/detection/light/trail_fit.h"
#include "core/detection/pixels/background.h"
#include "core/detection/pixels/components.h"

namespace dmise {

inline constexpr double min_variance_px2 = 0.1;  // along x and along y in an image

/// An image's place, second moments and light, weighted by a Gaussian of these moments.
struct SourceMoments {
  double x = 0.0, y = 0.0, flux = 0.0;
  double xx = 0.0, xy = 0.0, yy = 0.0;

  Symmetric2 spread() const { return {xx, xy, yy}; }
  double mean() const { return mean_of_axes(spread()); }
  double half() const { return half_of_axes(spread()); }
  /// Whether it is narrower than its pixels resolve: the moments then say nothing of its width.
  bool collapsed() const { return std::min(xx, yy) <= min_variance_px2; }
  double minor_sigma() const { return std::sqrt(std::max(mean() - half(), 1.0 / 12)); }
  double major_sigma() const { return std::sqrt(std::max(mean() + half(), 1.0 / 12)); }
  double angle_rad() const { return axis_angle_rad(spread()); }
};

/// Returns the length of the uniform trail that has the image's moments, without the star's width.
double trail_length_px(const SourceMoments& m, double sigma_px);

/// Measures single images in a frame.
class SourceMeasure {
 public:
  SourceMeasure(const CountImage& counts, const Background& background,
                const StarSourceSettings& settings)
      : counts_(counts), background_(background), settings_(settings) {}

  double signal_e(int x, int y) const {
    return (counts_.at(x, y) - background_.level_dn(x, y)) * settings_.gain_e_per_dn;
  }

  double noise_e(int x, int y) const {
    return background_.sigma_dn(x, y) * settings_.gain_e_per_dn;
  }
  bool is_saturated(const Component& c) const;
  double light_e(const Component& c) const;

  std::optional<SourceMoments> moments(const Component& c, double sigma_px) const;

  /// Fits a Gaussian of a width, or a line of it; empty if it does not converge.
  std::optional<TrailFit> fit(const SourceMoments& m, double sigma_px) const;
  std::optional<PlateSource> source(const SourceMoments& m, double sigma_px) const;
  PlateSource saturated_source(const Component& c, double sigma_px, double length_px) const;

 private:
  bool contains(int x, int y) const {
    return x >= 0 && y >= 0 && x < counts_.columns && y < counts_.rows;
  }
  bool saturated(int x, int y) const { return counts_.at(x, y) >= settings_.saturation_dn; }

  SourceMoments of_component(const Component& c, double sigma_px) const;

  /// One step of the adaptive moments of Bernstein & Jarvis 2002, AJ 123, 583, which for a Gaussian
  /// are its own moments.
  bool improve(SourceMoments& m) const;

  const CountImage& counts_;
  const Background& background_;
  const StarSourceSettings& settings_;
};

}  // namespace dmise
