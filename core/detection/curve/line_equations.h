#pragma once
#include <cstddef>
#include <vector>

#include "core/base/algebra/banded_matrix.h"
#include "core/detection/curve/streak_light.h"

namespace dmise {

/// Equations of light that varies, in electrons of a piece, from which all that is fitted beside it
/// is eliminated.
struct LightEquations {
  BandedMatrix matrix;  // full
  std::vector<double> right;
  std::vector<double> even_e;  // how much even light each unknown stands for
  // The highest frequency over that of the first harmonic, in equations of harmonics.
  double harmonics_shown = 0.0;
};

/// The light of a streak as even light with a slope and harmonics, beside free light at both ends
/// and the level of the background.
class LineEquations {
 public:
  explicit LineEquations(const StreakLight& light);

  /// Whether the light without harmonics has a solution.
  bool solvable() const { return solvable_; }
  double even_e() const { return value_[even_light]; }
  double even_variance_e2() const;

  /// Frequency of the shortest wave that the PSF leaves [1/px].
  double highest_frequency() const;
  /// Up to `most` of them.
  std::size_t harmonics_at(double frequency, std::size_t most) const;
  /// Equations of cosine and sine of each harmonic, up to `most`: as many as the PSF leaves `as_at`
  /// a frequency. One more of them would shift the frequency.
  LightEquations harmonics(double frequency, std::size_t most, double as_at) const;
  /// Equations of each bin between the ends.
  LightEquations bins() const;

 private:
  /// A function of the place along the line, in units in which the fit is linear, and its products
  /// with all others.
  struct Column {
    std::vector<double> shape;    // by pieces
    double background = 0.0;      // and an even background
    std::vector<double> product;  // the equations' matrix times this column
    double background_product = 0.0, right = 0.0;
  };
  /// Pieces at either end whose light is free: those beyond it, and as many within as its error may
  /// leave without light.
  static constexpr std::size_t free_pieces = pieces_beyond + 2;
  /// What is fitted beside harmonics: both ends, the background, even light and its slope.
  static constexpr std::size_t others = 2 * free_pieces + 3, even_light = others - 2;

  Column column(std::vector<double> shape, double background = 0.0) const;
  Column free_piece(std::size_t piece) const;
  template <class Function>
  Column along_line(const Function& of) const;
  static double product_of(const Column& a, const Column& b);
  LightEquations beside_others(const std::vector<Column>& columns) const;

  const StreakLight& light_;
  std::vector<Column> others_;
  BandedMatrix factor_;  // the factor of their equations
  bool solvable_ = false;
  std::vector<double> value_;  // light of the others alone
};

}  // namespace dmise
