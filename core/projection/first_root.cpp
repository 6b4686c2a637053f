#include "core/projection/first_root.h"

#include <vector>

namespace dmise {
namespace {

double value(std::span<const double> c, double x) {
  double sum = 0.0;
  for (std::size_t i = c.size(); i-- > 0;) sum = sum * x + c[i];
  return sum;
}

/// Returns the sign change of the polynomial between `a` and `b`, rounded towards `b`.
double bisect(std::span<const double> c, double a, double b) {
  const bool positive = value(c, a) > 0.0;
  for (double middle = 0.5 * (a + b); middle > a && middle < b; middle = 0.5 * (a + b))
    ((value(c, middle) > 0.0) == positive ? a : b) = middle;
  return b;
}

/// Returns 0, the turning points in between in ascending order, and `upto`.
std::vector<double> monotone_pieces(std::span<const double> c, double upto) {
  std::vector<double> ends{0.0};
  if (c.size() > 2) {
    std::vector<double> slope;
    for (std::size_t i = 1; i < c.size(); ++i) slope.push_back(double(i) * c[i]);
    const auto pieces = monotone_pieces(slope, upto);
    for (std::size_t i = 1; i < pieces.size(); ++i)
      if ((value(slope, pieces[i - 1]) > 0.0) != (value(slope, pieces[i]) > 0.0))
        ends.push_back(bisect(slope, pieces[i - 1], pieces[i]));
  }
  ends.push_back(upto);
  return ends;
}

}  // namespace

std::optional<double> first_root(std::span<const double> c, double upto) {
  const auto ends = monotone_pieces(c, upto);
  for (std::size_t i = 1; i < ends.size(); ++i)
    if (!(value(c, ends[i]) > 0.0)) return bisect(c, ends[i - 1], ends[i]);
  return std::nullopt;
}

}  // namespace dmise
