#pragma once
#include <vector>

namespace dmise {

/// A smooth curve through points that is monotone wherever they are: cubic between them, with a
/// continuous slope and no overshoot; constant outside. One point gives a constant, none gives 0.
/// Source: Fritsch & Butland 1984, SIAM J. Sci. Stat. Comput. 5, 300, as scipy's
/// PchipInterpolator, with its ends.
class MonotoneCubic {
 public:
  MonotoneCubic() = default;
  /// Throws `Error` if the places do not rise, a number is not finite, or their numbers differ.
  MonotoneCubic(std::vector<double> at, std::vector<double> value);

  bool empty() const { return at_.empty(); }
  const std::vector<double>& at() const { return at_; }
  const std::vector<double>& value() const { return value_; }
  const std::vector<double>& slope() const { return slope_; }  // at each place
  double operator()(double x) const;

  bool operator==(const MonotoneCubic&) const = default;

 private:
  std::vector<double> at_, value_, slope_;
};

}  // namespace dmise
