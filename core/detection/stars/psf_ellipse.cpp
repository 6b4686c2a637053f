#include "core/detection/stars/psf_ellipse.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/algebra/small_matrix.h"
#include "core/detection/source/source_fit.h"

namespace dmise {
namespace {

constexpr std::size_t star_terms = 5;  // a star's flux, x, y, background, log of the width
constexpr std::size_t all_terms = star_terms + 2;  // with the ellipticity
constexpr double reach_widths = 3.0;               // how far from a star pixels are used
constexpr double ellipse_error = 0.05;             // relative, where stars are not Gaussian
constexpr double step = 0.02;                      // for derivatives by differences
constexpr double elliptic_chi2 = 60.0;             // gain over a round PSF
constexpr double least = 0.02, most = 0.6;
constexpr int ellipse_rounds = 3;

struct Sum {
  double xx = 0.0, xd = 0.0, dd = 0.0, x = 0.0, d = 0.0;  // normal equations of the ellipticity
};

/// Adds the equations of one star, from which its own parameters are eliminated.
void add(const ShapeStar& star, const PsfField& field, Sum& sum) {
  const PixelPosition at{star.trail.x_px, star.trail.y_px};
  Psf gaussian = field.sigma_at(at);
  gaussian.along_x = field.along_x;
  gaussian.along_diagonal = field.along_diagonal;
  Psf wider = gaussian, along_x = gaussian, along_diagonal = gaussian;
  wider.parts[0].sigma_px *= 1 + step;
  along_x.along_x += step;
  along_diagonal.along_diagonal += step;
  const std::array<TrailLight, 4> light{
      TrailLight(star.trail, gaussian), TrailLight(star.trail, wider),
      TrailLight(star.trail, along_x), TrailLight(star.trail, along_diagonal)};
  const double reach_px = reach_widths * gaussian.parts[0].sigma_px;
  NormalEquations equations;
  SmallMatrix& matrix = equations.matrix;
  const SmallVector& right = equations.right;
  TrailDerivatives by{}, unused{};
  const Around around(star.trail, reach_px);
  for (const FitPixel& p : star.pixels) {
    if (!around.has(p.x, p.y)) continue;
    const double model = light[0](p.x, p.y, by);
    const auto change = [&](std::size_t k) { return (light[k](p.x, p.y, unused) - model) / step; };
    const std::array<double, all_terms> gradient = {by[2],     by[0],     by[1],    1.0,
                                                    change(1), change(2), change(3)};
    const double error = ellipse_error * model;
    const double weight = 1 / (p.variance_e2 + std::max(model, 0.0) + error * error);
    const double residual = p.signal_e - model - star.background_e;
    equations.add(weight, gradient, residual);
  }
  matrix[3][3] += 1 / (star.background_sigma_e * star.background_sigma_e);
  SmallMatrix factor = matrix;
  if (!cholesky(factor, star_terms)) return;
  const SmallVector at_rest = solve(factor, right, star_terms);
  std::array<SmallVector, 2> by_e;
  for (std::size_t k = 0; k < 2; ++k) {
    SmallVector column{};
    for (std::size_t i = 0; i < star_terms; ++i) column[i] = matrix[star_terms + k][i];
    by_e[k] = solve(factor, column, star_terms);
  }
  const auto without_own = [&](std::size_t k, const SmallVector& solution) {
    double product = 0.0;
    for (std::size_t i = 0; i < star_terms; ++i) product += matrix[star_terms + k][i] * solution[i];
    return product;
  };
  sum.x += right[star_terms] - without_own(0, at_rest);
  sum.d += right[star_terms + 1] - without_own(1, at_rest);
  sum.xx += matrix[star_terms][star_terms] - without_own(0, by_e[0]);
  sum.xd += matrix[star_terms + 1][star_terms] - without_own(1, by_e[0]);
  sum.dd += matrix[star_terms + 1][star_terms + 1] - without_own(1, by_e[1]);
}

}  // namespace

void fit_psf_ellipse(const std::vector<ShapeStar>& stars, PsfField& field) {
  for (int round = 0; round < ellipse_rounds; ++round) {
    Sum sum;
    for (const ShapeStar& star : stars) add(star, field, sum);
    const double determinant = sum.xx * sum.dd - sum.xd * sum.xd;
    if (!(sum.xx > 0 && determinant > 1e-6 * sum.xx * sum.dd)) return;
    const double x = (sum.dd * sum.x - sum.xd * sum.d) / determinant;
    const double d = (sum.xx * sum.d - sum.xd * sum.x) / determinant;
    if (round == 0 && (x * sum.x + d * sum.d < elliptic_chi2 || std::hypot(x, d) < least)) return;
    field.along_x += x;
    field.along_diagonal += d;
    const double size = std::hypot(field.along_x, field.along_diagonal);
    if (!(size < most)) {
      field.along_x *= most / size;
      field.along_diagonal *= most / size;
    }
  }
}

}  // namespace dmise
