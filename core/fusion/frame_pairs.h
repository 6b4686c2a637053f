#pragma once
#include <cstddef>
#include <vector>

#include "core/base/numeric/assignment.h"

namespace dmise {

/// Which source of a frame is of which object: pairs that passed a gate, their assignment, and what
/// else may have made a source.
class FramePairs {
 public:
  /// `detection_probability`: of an object that is there; `false_density`: of false alarms in the
  /// space of the innovations, such as directions [1/sr].
  FramePairs(double detection_probability, double false_density);

  /// Source `row` may be of object `column`, which exists with a probability. `d2`: squared length
  /// of the innovation over its covariance S; `spread`: logarithm of the determinant of 2 pi S.
  void add(std::size_t row, std::size_t column, double d2, double spread, double exists);

  /// The column of each row, or `unassigned`.
  std::vector<std::size_t> assigned(std::size_t rows, std::size_t columns) const;
  /// Density of what else may have made each source, if `columns` are its objects: a false alarm,
  /// or another object (Musicki & La Scala 2008, linear multitarget). Where objects are close, a
  /// pair is no proof.
  std::vector<double> others(const std::vector<std::size_t>& columns) const;
  /// Density with which an object shows a source; 0 of what is no pair.
  double likelihood(std::size_t row, std::size_t column) const;

 private:
  double detection_probability_, false_density_;
  double alone_;  // cost of a source without an object
  std::vector<Pairing> pairs_;
  std::vector<double> likelihoods_;
};

}  // namespace dmise
