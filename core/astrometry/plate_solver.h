#pragma once
#include <span>
#include <string>

#include "core/astrometry/plate_match.h"
#include "core/astrometry/star_patterns.h"
#include "core/base/units.h"

namespace dmise {

/// What is believed of a camera before its frame is solved.
struct PlateBelief {
  int columns = 0, rows = 0;
  Projection projection;
  /// 0: not known. The axis is taken at the image's centre.
  double focal_length_px = 0.0;
  /// Where it points, if that is believed (determinant -1: mirrored).
  std::optional<Rotation<CameraFrame, Gcrs>> camera_from_gcrs;
};

/// How far beliefs may be wrong, and what to look for without any.
struct PlateSearch {
  double pointing_error_rad = 3 * deg, roll_error_rad = 8 * deg;
  double focal_error = 0.05;  // relative
  /// Range of the frame's width on the sky if the focal length is not known.
  double narrowest_rad = 0.8 * deg, widest_rad = 100 * deg;
  double least_log_odds = 13.8;  // one chance in a million to be wrong
  double star_sigma_rad = 0.05 * arcsec;  // error of the catalogue's places
  std::size_t most_stars = 2000;          // that take part in the final fit
  int most_order = 5;                     // of the distortion
};

struct PlateSolution {
  PlateFit fit;
  std::vector<SeenStar> stars;
  std::vector<PlateMatch> matches;  // of `stars` with sources, by the order given
  double log_odds = 0.0;            // that it is no chance, of all that was tried
  std::size_t tried = 0;            // candidates that were looked at
};

/// Finds the plate of a frame from its sources (in any order; those with numbers that are not
/// finite or out of the frame are passed over). With a believed pointing the sky around it is
/// searched, else all of it. A `cache` of the sky's catalogue saves the next blind solution time.
/// Deterministic. Throws `Error` with the reason if there is none.
PlateSolution solve_plate(std::span<const PlateSource> sources, const PlateBelief& belief,
                          const PlateSky& sky, const PlateSearch& search = {},
                          PatternCache* cache = nullptr);

}  // namespace dmise
