#pragma once
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/detection/source/scene.h"

namespace dmise {

/// What lies within a distance of a trail.
class Around {
 public:
  Around(const Trail& trail, double margin_px);

  bool has(double x_px, double y_px) const {
    const double dx = x_px - trail_.x_px, dy = y_px - trail_.y_px;
    const double along = dx * cos_ + dy * sin_, across = dy * cos_ - dx * sin_;
    const double half = trail_.length_px / 2;
    const double r = half > 0 ? std::clamp(along / half, -1.0, 1.0) : 0.0;
    const double off = across - trail_.sagitta_px * (1.0 / 3 - r * r);
    const double beyond = std::max(std::abs(along) - half, 0.0);
    return off * off + beyond * beyond <= margin_px_ * margin_px_;
  }

  /// Calls visit(y, begin, end) for the rows of a frame within the distance, with the columns from
  /// `begin` to before `end` outside of which nothing is.
  template <class Visit>
  void for_rows(int columns, int rows, const Visit& visit) const {
    const double margin = margin_px_ + std::abs(trail_.sagitta_px), half = trail_.length_px / 2;
    const double reach_x = half * std::abs(cos_) + margin, reach_y = half * std::abs(sin_) + margin;
    const auto first = [](double px, int count) {
      return int(std::clamp(std::floor(px), 0.0, double(count)));
    };
    const auto last = [](double px, int count) {
      return int(std::clamp(std::ceil(px), -1.0, double(count - 1)));
    };
    const int x0 = first(trail_.x_px - reach_x, columns), x1 = last(trail_.x_px + reach_x, columns);
    const int y1 = last(trail_.y_px + reach_y, rows);
    for (int y = first(trail_.y_px - reach_y, rows); y <= y1; ++y) {
      const auto [left, right] = columns_near(y);
      const int begin = std::max(x0, left), end = std::min(x1, right) + 1;
      if (begin < end) visit(y, begin, end);
    }
  }

 private:
  std::pair<int, int> columns_near(int y) const;

  Trail trail_;
  double margin_px_, cos_, sin_;
};

/// Unsaturated pixels on the trail.
std::vector<FitPixel> pixels_near(const Scene& scene, const Trail& trail, double margin_px);

/// Pixels without those far above or below the trails' light, and their neighbours. `tolerance`:
/// relative error of the model.
std::vector<FitPixel> without_outliers(const std::vector<FitPixel>& pixels,
                                       std::span<const Trail> trails, double background_e,
                                       double tolerance, const Psf& psf);

/// Error of the background's mesh at a pixel, the prior of a constant background of fits.
double background_sigma_e(const FitPixel& pixel);

/// Whether a trail is finite, and no longer or more bent than a frame can show. Whatever steps
/// along a fitted trail asks this first: nothing else bounds a fit that has left the frame.
bool is_bounded(const Scene& scene, const Trail& trail);

/// Whether a trail is bounded, of positive flux and centred in the frame.
bool plausible(const Scene& scene, const Trail& trail);

/// Fits a source that is not a star, over all pixels near `start` of any component, with a
/// free local background; outlying pixels (stars underneath) are rejected. Empty if the fit fails
/// or leaves the frame. A `draft` stops before the ends have converged. `free`: the parameters of
/// the trail that are fitted; 0: those that its length can show.
std::optional<Source> fit_source(const Scene& scene, const Trail& start, bool streak,
                                 double model_error, bool draft = false, unsigned free = 0);

/// One of the trails of a joint fit with a background as a source: its parameters, of which each
/// trail has those of `free`, and the background, of the whole covariance.
Source part_of(const TrailFit& fit, std::size_t which, unsigned free);

/// Whether pixels across a trail have values at a place along it, in the frame or the nearest to
/// it.
bool has_values_at(const Scene& scene, const Trail& trail, double along_px);

/// Puts ends of a fitted streak that are beyond the frame, or among pixels without a value, on the
/// edge.
void hold_ends_at_edge(const Scene& scene, Source& source);

/// Flags a source by where its trail is: at the frame's edge or that of pixels without a value,
/// saturated.
void set_flags(const Scene& scene, const Trail& trail, Source& source);

}  // namespace dmise
