#include "core/optics/waves/phase_screen.h"

#include <fftw3.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/units.h"

namespace dmise {
namespace {

constexpr double alpha = 5.0 / 3.0;
// Stein's covariance: 1 - r^alpha + c2 r^2 up to r = 1 (plus a constant), then a smooth end at 2.
constexpr double radius = 2.0;
constexpr double beta = alpha * (2 - alpha) / (3 * radius * (radius * radius - 1));
constexpr double c2 = 0.5 * (alpha - beta * (radius - 1) * (radius - 1) * (radius + 2));
constexpr double c0 = beta * (radius - 1) * (radius - 1) * (radius - 1) + 1 - c2;

double covariance(double r) {
  if (r <= 1.0) return c0 - std::pow(r, alpha) + c2 * r * r;
  if (r <= radius) return beta * std::pow(radius - r, 3) / r;
  return 0.0;
}

int torus_side(double unit) { return good_fft_size(int(std::ceil(2 * radius * unit)) + 1, true); }

}  // namespace

double kolmogorov_structure(double separation, double r0) {
  return 6.88 * std::pow(separation / r0, alpha);
}

double von_karman_structure(double separation, double r0, double outer_scale) {
  if (!std::isfinite(outer_scale)) return kolmogorov_structure(separation, r0);
  // Below this the difference of the two terms loses precision.
  const double x = 2 * pi * separation / outer_scale;
  if (x < 1e-6) return kolmogorov_structure(separation, r0);
  const double scale = 2 * std::tgamma(11.0 / 6) /
                       (std::pow(2.0, 5.0 / 6) * std::pow(pi, 8.0 / 3)) *
                       std::pow(24.0 / 5 * std::tgamma(6.0 / 5), 5.0 / 6);
  const double bessel = x < 600 ? std::pow(x, 5.0 / 6) * std::cyl_bessel_k(5.0 / 6, x) : 0.0;
  return scale * std::pow(outer_scale / r0, alpha) *
         (std::tgamma(5.0 / 6) / std::pow(2.0, 1.0 / 6) - bessel);
}

KolmogorovScreens::KolmogorovScreens(int side, double outer_scale)
    : side_(side),
      torus_(torus_side(std::sqrt(2.0) * side)),
      unit_(std::sqrt(2.0) * side),
      fft_(torus_) {
  if (side < 2 || side > 1024) throw Error("phase screen: side must be 2..1024 samples");
  if (!(outer_scale > 0.0)) throw Error("phase screen: the outer scale must be > 0");
  field_ = FftBuffer(2 * std::size_t(torus_) * std::size_t(torus_));
  // Eigenvalues: the cosine transform of the covariance, in double precision, because they span
  // more than seven digits.
  const int n = torus_ / 2 + 1;
  std::vector<double> lambda(std::size_t(n) * std::size_t(n));
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x)
      lambda[std::size_t(y) * std::size_t(n) + std::size_t(x)] =
          covariance(std::hypot(x, y) / unit_);
  const fftw_plan plan = fftw_plan_r2r_2d(n, n, lambda.data(), lambda.data(), FFTW_REDFT00,
                                          FFTW_REDFT00, FFTW_ESTIMATE);
  fftw_execute(plan);
  fftw_destroy_plan(plan);
  amplitude_.resize(lambda.size());
  for (std::size_t i = 0; i < lambda.size(); ++i)
    amplitude_[i] = float(std::sqrt(std::max(0.0, lambda[i])) / torus_);
  tilt_ = std::sqrt(2 * c2) / unit_;
  if (!std::isfinite(outer_scale)) return;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const double k2 = (double(x) * x + double(y) * y) / (double(torus_) * torus_);
      amplitude_[std::size_t(y) * std::size_t(n) + std::size_t(x)] *=
          float(std::pow(k2 / (k2 + 1 / (outer_scale * outer_scale)), 11.0 / 12));
    }
  tilt_ = 0.0;
  const int third = std::max(1, side / 3);
  const double lacking =
      von_karman_structure(third, 1.0, outer_scale) - expected_structure(third, 0);
  tilt_ = std::sqrt(std::max(0.0, lacking / (0.5 * kolmogorov_structure(unit_, 1.0)))) / third;
}

void KolmogorovScreens::transform_noise(const RngKey& key, std::uint32_t draw) {
  const auto torus = std::size_t(torus_), n = torus / 2 + 1;
  for (std::size_t y = 0; y < torus; ++y) {
    const float* a = amplitude_.data() + std::min(y, torus - y) * n;
    float* row = field_.data() + 2 * y * torus;
    rng_normals(key, std::uint32_t(2 * y * torus), 2 * draw, {row, 2 * torus});
    for (std::size_t x = 0; x < torus; ++x) {
      const float amplitude = a[std::min(x, torus - x)];
      row[2 * x] *= amplitude;
      row[2 * x + 1] *= amplitude;
    }
  }
  fft_.transform(field_);
}

// Real and imaginary part are independent fields; each has a tilt that corrects c2 r^2.
KolmogorovScreens::Tilt KolmogorovScreens::tilt(const RngKey& key, std::uint32_t draw,
                                                std::uint32_t part) const {
  const auto along = [&](std::uint32_t axis) {
    return tilt_ * normal_of(rng_word(key, 2 * part + axis, 2 * draw + 1));
  };
  return {along(0), along(1)};
}

std::array<KolmogorovScreens::Tilt, 2> KolmogorovScreens::draw_fields(const RngKey& key,
                                                                      std::uint32_t draw,
                                                                      std::vector<float>& first,
                                                                      std::vector<float>& second) {
  transform_noise(key, draw);
  const auto size = std::size_t(torus_) * std::size_t(torus_);
  const double scale = std::sqrt(0.5 * kolmogorov_structure(unit_, 1.0));
  first.resize(size);
  second.resize(size);
  for (std::size_t i = 0; i < size; ++i) {
    first[i] = float(scale * field_.data()[2 * i]);
    second[i] = float(scale * field_.data()[2 * i + 1]);
  }
  const Tilt a = tilt(key, draw, 0), b = tilt(key, draw, 1);
  return {Tilt{scale * a.x, scale * a.y}, Tilt{scale * b.x, scale * b.y}};
}

double KolmogorovScreens::expected_structure(int dx, int dy) const {
  const int n = torus_ / 2 + 1;
  const auto weight = [&](int k) { return k == 0 || 2 * k == torus_ ? 1.0 : 2.0; };
  double sum = 0.0;
  std::vector<double> cosine_x(std::size_t(n), 0.0);
  for (int k = 0; k < n; ++k) cosine_x[std::size_t(k)] = std::cos(2 * pi * k * double(dx) / torus_);
  for (int j = 0; j < n; ++j) {
    const double cosine_y = std::cos(2 * pi * j * double(dy) / torus_);
    for (int k = 0; k < n; ++k) {
      const double a = amplitude_[std::size_t(j) * std::size_t(n) + std::size_t(k)];
      sum += weight(j) * weight(k) * a * a * (1 - cosine_x[std::size_t(k)] * cosine_y);
    }
  }
  const double tilt = tilt_ * tilt_ * (double(dx) * dx + double(dy) * dy);
  return 0.5 * kolmogorov_structure(unit_, 1.0) * (2 * sum + tilt);
}

}  // namespace dmise
