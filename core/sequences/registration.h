#pragma once
#include <array>
#include <string>
#include <vector>

#include "core/base/algebra/small_matrix.h"
#include "core/base/algebra/symmetric2.h"
#include "core/base/pixel.h"
#include "core/sequences/filtered_sequence.h"
#include "core/wcs/wcs.h"

namespace dmise {

/// Linear map of pixels: to = shift + matrix (from - about).
struct LinearMap {
  PixelPosition about, shift;
  std::array<double, 4> matrix{1, 0, 0, 1};  // xx xy yx yy

  PixelPosition operator()(PixelPosition p) const {
    const PixelPosition d = p - about;
    return {shift.x_px + matrix[0] * d.x_px + matrix[1] * d.y_px,
            shift.y_px + matrix[2] * d.x_px + matrix[3] * d.y_px};
  }
  LinearMap inverse() const;
};

/// A map by stars and its error.
struct RegisteredMap {
  LinearMap map;
  std::size_t parameters = 0;  // that were fitted: both shifts, then the matrix
  SmallMatrix factor{};        // Cholesky's, of their information
  double misfit = 1.0;         // squares of ways over those by the errors of stars
};

/// Where the sky of a pixel of the reference frame is in the other frames, and back, by the frames'
/// world coordinates, if all have them, and by the stars that they share.
class Registration {
 public:
  /// Throws `Error` if frames without world coordinates share too few stars.
  Registration(const std::vector<SequenceFrame>& frames, const FilteredSequence& sequence);

  /// Far outside of any frame where there is none.
  PixelPosition in_frame(std::size_t frame, PixelPosition reference) const;
  PixelPosition in_reference(std::size_t frame, PixelPosition place) const;
  /// Covariance of a place in a frame, for one that is known in the reference frame: half of it is
  /// by the stars of each. 0 for the reference frame.
  Symmetric2 error_px2(std::size_t frame, PixelPosition reference) const;
  /// The map from frame to frame around a place.
  LinearMap around(std::size_t from, std::size_t to, PixelPosition place, double reach_px) const;
  /// Light of stars in a frame over that in the reference frame.
  double transmission(std::size_t frame) const { return maps_[frame].transmission; }
  /// Names frames that share too few stars, and are registered by their world coordinates alone.
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  struct Map {
    RegisteredMap by_stars;  // from where world coordinates expect a place, to where it is
    LinearMap back;
    double transmission = 1.0;
  };
  PixelPosition expected(std::size_t frame, PixelPosition reference) const;
  void fit(const FilteredSequence& sequence, std::size_t frame, const std::string& name);

  std::vector<const Wcs*> wcs_;  // one for each frame; empty: they have none
  std::size_t reference_;
  std::vector<Map> maps_;
  std::vector<std::string> notes_;
};

}  // namespace dmise
