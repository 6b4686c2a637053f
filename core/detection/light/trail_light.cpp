#include "core/detection/light/trail_light.h"

#include <algorithm>
#include <cmath>

#include "core/base/numeric/simd_level.h"
#include "core/base/units.h"
#include "core/detection/light/trail_kernels.h"
#include "core/detection/light/trail_lanes.h"

namespace dmise {
namespace {

constexpr double point_length_px = 1e-3;  // shorter is a point: the limit is exact to 1e-7

constexpr double square_below_px = 0.75;  // narrower parts have the square's term
static_assert(TrailShape::max_parts == Psf::most);

struct Table : NormalTable {
  Table() {
    for (int i = 0; i <= 2 * half; ++i) {
      const double x = (i - half) * step;
      cdf[i] = 0.5 * std::erfc(-x / std::sqrt(2.0));
      pdf[i] = std::exp(-0.5 * x * x) / std::sqrt(2 * pi);
    }
  }
};
const Table table;

/// The normal distribution at a number.
struct Normal {
  double pdf(double x) const {
    double cdf, pdf;
    both(x, cdf, pdf);
    return pdf;
  }
  void both(double x, double& cdf, double& pdf) const {
    cdf = x > NormalTable::reach ? 1.0 : 0.0;
    pdf = 0.0;
    if (!(x > -NormalTable::reach) || x > NormalTable::reach) return;
    const int i = int(x * (1 / NormalTable::step) + (NormalTable::half + 0.5));
    const double x0 = (i - NormalTable::half) * NormalTable::step, h = x - x0, p = table.pdf[i];
    cdf = normal_cdf_near(x0, h, table.cdf[i], p);
    pdf = normal_pdf_near(x0, h, p);
  }
};

}  // namespace

const NormalTable& normal_table() { return table; }

double normal_density(double x) { return Normal().pdf(x); }

void normal_below_each(std::vector<double>& values) {
  static const auto below_each = kernel_of(best_simd_level(), sse2::normal_below_each,
                                           avx2::normal_below_each, avx512::normal_below_each);
  below_each(table, values.data(), values.size(), values.data());
}

TrailLight::TrailLight(const Trail& trail, const Psf& psf) {
  // -1/2880 (d^4/dx^4 + d^4/dy^4), turned by the trail's angle.
  constexpr double square = -1.0 / 2880;
  TrailShape& t = shape_;
  const double c = std::cos(trail.angle_rad), s = std::sin(trail.angle_rad);
  const double c2 = c * c, s2 = s * s;
  t.x_px = trail.x_px;
  t.y_px = trail.y_px;
  t.flux_e = trail.flux_e;
  t.length_px = trail.length_px;
  t.slope = trail.slope;
  t.sagitta_px = trail.sagitta_px;
  t.cos_angle = c;
  t.sin_angle = s;
  t.is_point = trail.length_px < point_length_px;
  t.fourth = square * (c2 * c2 + s2 * s2);
  t.mixed = square * 12 * c2 * s2;
  t.odd = square * 4 * c * s * (s2 - c2);
  t.parts = psf.count;
  for (std::size_t i = 0; i < t.parts; ++i) {
    t.weight[i] = psf.parts[i].weight;
    const double sigma_px = psf.parts[i].sigma_px;
    t.along[i] = t.across[i] = 1 / sigma_px;
    if (psf.along_x != 0.0 || psf.along_diagonal != 0.0) {
      // The Gaussian along the line and across it; along it at a place across.
      const double optical = sigma_px * sigma_px - pixel_variance_px2, cc = c2 - s2, cs = 2 * c * s;
      const double stretch = optical * (psf.along_x * cc + psf.along_diagonal * cs);
      const double both = optical * (psf.along_diagonal * cc - psf.along_x * cs);
      const double across = sigma_px * sigma_px - stretch;
      t.lean[i] = both / across;
      t.along[i] = 1 / std::sqrt(sigma_px * sigma_px + stretch - both * t.lean[i]);
      t.across[i] = 1 / std::sqrt(across);
    }
    t.is_narrow[i] = t.along[i] > 1 / square_below_px;
  }
}

double TrailLight::operator()(double x, double y, TrailDerivatives& by) const {
  return light_of_trail(
      shape_, x, y, Normal(), [](double v) { return std::clamp(v, -1.0, 1.0); }, by.data());
}

double trail_value(const Trail& trail, const Psf& psf, double x, double y) {
  TrailDerivatives unused{};
  return TrailLight(trail, psf)(x, y, unused);
}

}  // namespace dmise
