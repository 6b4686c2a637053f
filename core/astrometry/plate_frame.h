#pragma once
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "core/astrometry/plate_match.h"
#include "core/base/units.h"

namespace dmise {

/// What is believed of a camera before its frame is solved.
struct PlateHint {
  int columns = 0, rows = 0;
  Projection projection;
  /// 0: not known. The axis is taken at the image's centre.
  double focal_length_px = 0.0;
  /// Where it points, if that is believed (determinant -1: mirrored).
  std::optional<Rotation<CameraFrame, Gcrs>> camera_from_gcrs;
  /// Or only the direction of the image's centre, if that is believed; roll and parity are not.
  std::optional<Vec<Gcrs>> axis;
};

/// How far hints may be wrong, and what to look for without any.
struct PlateSearch {
  double pointing_error_rad = 3 * deg, roll_error_rad = 8 * deg;
  double focal_error = 0.05;  // relative
  /// Range of the frame's width on the sky if the focal length is not known.
  double narrowest_rad = 0.8 * deg, widest_rad = 100 * deg;
  double min_log_odds = 13.8;             // one chance in a million to be wrong
  double star_sigma_rad = 0.05 * arcsec;  // error of the catalogue's places
  std::size_t max_stars = 2000;           // that take part in the final fit
  int max_order = 5;                      // highest order of the distortion
};

/// A fit that leaves something else free and that the stars do not exclude.
struct PlateRival {
  PlateFit fit;
  double weight = 0.0;  // odds against the fit that was chosen, by Bayes' information criterion
};

struct PlateSolution {
  PlateFit fit;
  std::vector<PlateRival> rivals;
  double reach_px = 0.0;  // from the frame's middle to the farthest star of the fit
  /// Radial distortion in a corner that the fit leaves out and its stars allow, rms.
  double left_out_px = 0.0;
  std::vector<SeenStar> stars;
  std::vector<PlateMatch> matches;  // pairs `stars` with sources, by the order given
  double log_odds = 0.0;            // that it is no chance match among all that were tried
  std::size_t tried = 0;            // candidates

  /// Standard deviation of the plate's place of a direction along one axis [px]: of the fit, with
  /// what its rivals say there and, beyond the stars, what a lens may do that no star shows.
  double sigma_px(const Vec<Gcrs>& direction, PixelPosition pixel) const;
};

/// Compares a frame's sources with the sky: extends a guess of the plate over the frame and judges
/// it.
class PlateFrame {
 public:
  /// Sources in any order; those with numbers that are not finite, out of the frame or within half
  /// a pixel of a brighter one are ignored.
  PlateFrame(std::span<const PlateSource> sources, const PlateHint& hint, const PlateSky& sky,
             const PlateSearch& search);

  /// By falling flux.
  std::span<const PlateSource> sources() const { return sources_; }
  PixelPosition place(std::size_t source) const {
    return {sources_[source].x_px, sources_[source].y_px};
  }
  PixelPosition centre() const { return {(hint_.columns - 1) / 2.0, (hint_.rows - 1) / 2.0}; }
  double half_diagonal_px() const { return 0.5 * std::hypot(hint_.columns, hint_.rows); }
  /// Angle from a plate's axis to the farthest corner.
  double reach_rad(const PlateModel& model) const;

  /// Whether the stars around a pattern of stars (by number in the catalogue) have images, too, as
  /// far as there are any; `from` is the first star's image, `size_px` the distance of the
  /// second's.
  bool stars_beside(const PlateModel& model, std::span<const std::uint32_t> pattern,
                    PixelPosition from, double size_px) const;
  /// Extends a plate that holds around a place over the frame; empty if the stars do not follow.
  std::optional<PlateModel> grow(const PlateModel& start, PixelPosition from, double size_px) const;
  /// Fits a plate with all sources, as freely as the stars support. `log_odds` is by the stars
  /// alone, `tried` 0. Empty without enough stars.
  std::optional<PlateSolution> fit(PlateModel model) const;

 private:
  /// Fits matches with each of a list of freedoms and chooses by Bayes' information criterion;
  /// tells the solution the others that may be right, and what distortion the fit leaves out.
  std::optional<PlateFit> best_fit(const PlateModel& model, std::span<const PlateMatch> pairs,
                                   PlateSolution& solution) const;
  /// Stars about the frame, of which it shows somewhat more than it has sources.
  std::vector<SeenStar> stars_around(const PlateModel& model, std::size_t sources) const;
  double star_sigma_px(const PlateModel& model) const {
    return search_.star_sigma_rad * model.focal_length_px;
  }

  const PlateHint& hint_;
  const PlateSky& sky_;
  const PlateSearch& search_;
  std::vector<PlateSource> sources_;     // by falling flux
  std::vector<std::uint32_t> original_;  // their places in the caller's list
  std::size_t bright_ = 0;               // sources with which a plate grows
  std::optional<SourceGrid> bright_grid_;
};

}  // namespace dmise
