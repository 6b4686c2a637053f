#pragma once
#include <span>
#include <vector>

#include "core/astrometry/plate_fit.h"
#include "core/astrometry/plate_sky.h"

namespace dmise {

/// A measured image that may be a star.
struct PlateSource {
  double x_px = 0.0, y_px = 0.0;
  double flux = 0.0;                       // any unit
  std::array<double, 3> covariance_px2{};  // var x, cov xy, var y
  double flux_sigma = 0.0;
  bool saturated = false;  // place and flux are not to be relied on
};

/// Sources by place.
class SourceGrid {
 public:
  SourceGrid(std::span<const PlateSource> sources, int columns, int rows);

  /// The nearest source within a distance; -1: none.
  int nearest(PixelPosition at, double within_px) const;

 private:
  std::span<const PlateSource> sources_;
  double cell_px_;
  int columns_, rows_;  // size of the grid of cells
  std::vector<std::uint32_t> first_, order_;
};

/// How far a match may lie off: `near_px`, growing beyond `known_px` from a place.
struct MatchReach {
  PixelPosition from;
  double near_px = 1.0, known_px = 1e9, growth = 0.0, max_px = 1e9;
  double at(PixelPosition place) const;
};

/// Pairs each star that is imaged within the frame with the nearest source within reach; of stars
/// with the same source the nearest.
std::vector<PlateMatch> match(const PlateModel& model, std::span<const SeenStar> stars,
                              std::span<const PlateSource> sources, const SourceGrid& grid,
                              int columns, int rows, const MatchReach& reach);

/// Logarithm of the odds, against chance, that the sources are images of the stars (by rising
/// magnitude): each star with a source near its place raises them, each without lowers them.
/// Returns the maximum over the stars from the brightest to any other. As many matches as determine
/// the plate's parameters do not count.
double log_odds(const PlateModel& model, std::span<const SeenStar> stars, const PlateFit& fit,
                std::span<const PlateMatch> pairs, std::size_t sources, int columns, int rows);

}  // namespace dmise
