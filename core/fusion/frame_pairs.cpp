#include "core/fusion/frame_pairs.h"

#include <cmath>

namespace dmise {

FramePairs::FramePairs(double detection_probability, double false_density)
    : detection_probability_(detection_probability),
      false_density_(false_density),
      alone_(2 * std::log(false_density * (1 - detection_probability) / detection_probability)) {}

void FramePairs::add(std::size_t row, std::size_t column, double d2, double spread, double exists) {
  pairs_.push_back({row, column, d2 + spread + alone_});
  likelihoods_.push_back(detection_probability_ * exists * std::exp(-(d2 + spread) / 2));
}

std::vector<std::size_t> FramePairs::assigned(std::size_t rows, std::size_t columns) const {
  return assign(rows, columns, pairs_);
}

std::vector<double> FramePairs::others(const std::vector<std::size_t>& columns) const {
  std::vector<double> out(columns.size(), false_density_);
  for (std::size_t i = 0; i < pairs_.size(); ++i)
    if (columns[pairs_[i].row] != pairs_[i].column) out[pairs_[i].row] += likelihoods_[i];
  return out;
}

double FramePairs::likelihood(std::size_t row, std::size_t column) const {
  for (std::size_t i = 0; i < pairs_.size(); ++i)
    if (pairs_[i].row == row && pairs_[i].column == column) return likelihoods_[i];
  return 0.0;
}

}  // namespace dmise
