#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/base/algebra/banded_matrix.h"
#include "core/detection/source/scene.h"

namespace dmise {

/// Pieces before the line and behind it.
inline constexpr std::size_t pieces_beyond = 3;

/// The light of a streak as a sum of short pieces of its line, each even and blurred by the PSF:
/// the normal equations of their light by linear least squares over the pixels, weighted by the
/// noise of sky and light. `pieces_beyond` pieces before and behind the line have the light that an
/// error of its ends leaves there.
struct StreakLight {
  double length_px = 0.0, fwhm_px = 0.0;
  double piece_px = 0.0;
  std::size_t pieces = 0;                 // on the line, an even number
  BandedMatrix matrix;                    // equations of all pieces, those beyond the ends too
  std::vector<double> right, background;  // products with the pixels, and with an even background
  std::vector<double> seen;               // share of a piece's light in pixels that are used
  double background_weight = 0.0, background_right = 0.0;
  double reduced_chi2 = 0.0;  // by the pixels around the line

  /// By which squares of errors are more than by the noise.
  double misfit() const { return std::max(reduced_chi2, 1.0); }

  /// Middle of a piece along the line from its middle.
  double along_px(std::size_t piece) const {
    return (double(piece) - double(pieces_beyond) + 0.5) * piece_px - length_px / 2;
  }
  std::size_t all_pieces() const { return pieces + 2 * pieces_beyond; }
};

/// Pieces of a bin, which is about a FWHM long: shorter ones have no light that the PSF shows.
inline constexpr std::size_t pieces_of_bin = 2;

/// Light of bins with the errors of one and of neighbours, which the background's is part of.
struct BinnedLight {
  std::vector<double> light_e, variance_e2, next_e2,
      second_e2;                  // covariances with the next two bins
  std::vector<bool> is_measured;  // whether pixels show it
  double background_e = 0.0;
};

/// Empty for a streak shorter than four FWHM, or one of which too few pixels are usable.
std::optional<StreakLight> streak_light(const Scene& scene, const Source& source);

/// Light beyond the ends, in all pieces there, in units of its error and of even light.
struct LightBeyond {
  double sigmas = 0.0, share = 0.0;
};
/// Before the first end and behind the last.
std::array<LightBeyond, 2> light_beyond(const StreakLight& light);

/// Sets the light of a streak and its slope to those of all its pieces, with their errors.
void set_light(const StreakLight& light, Source& source);

/// The source with its line moved and turned to where pieces explain the pixels best.
Source aligned(const Scene& scene, Source source);

BinnedLight binned(const StreakLight& light);

}  // namespace dmise
