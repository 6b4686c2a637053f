#include "core/base/algebra/least_squares.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"

namespace dmise {

std::vector<double> least_squares(std::vector<double> a, std::size_t columns, std::vector<double> b,
                                  std::size_t sides) {
  const std::size_t rows = columns ? a.size() / columns : 0;
  if (!columns || rows < columns) throw Error("least squares: fewer equations than unknowns");
  double largest = 0.0;
  std::vector<double> v(rows), diagonal(columns);
  for (std::size_t k = 0; k < columns; ++k) {
    double sum = 0.0;
    for (std::size_t i = k; i < rows; ++i) sum += a[i * columns + k] * a[i * columns + k];
    const double length = std::sqrt(sum);
    largest = std::max(largest, length);
    if (!(length > 1e-14 * largest)) throw Error("least squares: unknowns are not independent");
    const double alpha = a[k * columns + k] > 0 ? -length : length;
    for (std::size_t i = k; i < rows; ++i) v[i] = a[i * columns + k];
    v[k] -= alpha;
    const double scale = 1.0 / (alpha * v[k]);  // -2 / |v|^2
    const auto reflect = [&](std::vector<double>& m, std::size_t width, std::size_t j) {
      double s = 0.0;
      for (std::size_t i = k; i < rows; ++i) s += v[i] * m[i * width + j];
      for (std::size_t i = k; i < rows; ++i) m[i * width + j] += scale * s * v[i];
    };
    for (std::size_t j = k + 1; j < columns; ++j) reflect(a, columns, j);
    for (std::size_t j = 0; j < sides; ++j) reflect(b, sides, j);
    diagonal[k] = alpha;
  }
  std::vector<double> x(columns * sides);
  for (std::size_t k = columns; k-- > 0;)
    for (std::size_t j = 0; j < sides; ++j) {
      double s = b[k * sides + j];
      for (std::size_t i = k + 1; i < columns; ++i) s -= a[k * columns + i] * x[i * sides + j];
      x[k * sides + j] = s / diagonal[k];
    }
  return x;
}

}  // namespace dmise
