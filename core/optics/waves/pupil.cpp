#include "core/optics/waves/pupil.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/units.h"

namespace dmise {
namespace {

/// A Zernike polynomial with its radial coefficients.
class ZernikePolynomial {
 public:
  explicit ZernikePolynomial(int noll) {
    if (noll < 1 || noll > 66) throw Error("zernike: Noll index must be 1..66");
    const auto [n, signed_m] = noll_orders(noll);
    sine_ = signed_m < 0;
    m_ = std::abs(signed_m);
    terms_ = (n - m_) / 2 + 1;
    const double norm = std::sqrt(m_ == 0 ? n + 1.0 : 2.0 * (n + 1));
    for (int k = 0; k < terms_; ++k)  // factor of rho^(n - 2k)
      coefficient_[std::size_t(k)] =
          norm * (k % 2 ? -1.0 : 1.0) * factorial(n - k) /
          (factorial(k) * factorial((n + m_) / 2 - k) * factorial((n - m_) / 2 - k));
  }
  /// At a place in aperture radii, at most 1 from the centre.
  double at(std::complex<double> place) const {
    const double rho2 = std::norm(place);
    double radial = 0.0;
    for (int k = 0; k < terms_; ++k) radial = radial * rho2 + coefficient_[std::size_t(k)];
    std::complex<double> turned = 1.0;  // rho^m in the direction m theta
    for (int i = 0; i < m_; ++i)
      turned = {turned.real() * place.real() - turned.imag() * place.imag(),
                turned.real() * place.imag() + turned.imag() * place.real()};
    return radial * (sine_ ? turned.imag() : turned.real());
  }

 private:
  static double factorial(int n) {
    double product = 1.0;
    for (int i = 2; i <= n; ++i) product *= i;
    return product;
  }
  int m_ = 0, terms_ = 1;
  bool sine_ = false;
  std::array<double, 6> coefficient_{};
};

// Whether the pupil is open at a position in aperture diameters from the centre.
bool is_open(const Pupil& p, double x, double y) {
  const double r2 = x * x + y * y;
  if (r2 > 0.25 || r2 < 0.25 * p.obscuration * p.obscuration) return false;
  for (int i = 0; i < p.spiders; ++i) {
    const double angle = 2 * pi * i / p.spiders;
    const double along = x * std::cos(angle) + y * std::sin(angle);
    const double across = std::abs(y * std::cos(angle) - x * std::sin(angle));
    if (along > 0 && across * p.aperture_m < 0.5 * p.spider_width_m) return false;
  }
  return true;
}

// Fraction of a sample's cell that is open, by 4 x 4 points.
double open_share(const Pupil& p, double x, double y, double step) {
  const double r = std::hypot(x, y);
  if (r > 0.5 + step) return 0.0;
  if (p.spiders == 0 && r + step < 0.5 && r - step > 0.5 * p.obscuration) return 1.0;
  constexpr int points = 4;
  int open = 0;
  for (int j = 0; j < points; ++j)
    for (int i = 0; i < points; ++i)
      open +=
          is_open(p, x + ((i + 0.5) / points - 0.5) * step, y + ((j + 0.5) / points - 0.5) * step);
  return double(open) / (points * points);
}

}  // namespace

std::array<int, 2> noll_orders(int noll) {
  int n = 0, first = 1;
  while (noll >= first + n + 1) first += ++n;
  const int place = noll - first;
  const int m = n % 2 ? 2 * (place / 2) + 1 : 2 * ((place + 1) / 2);
  return {n, noll % 2 ? -m : m};
}

double zernike(int noll, double rho, double theta_rad) {
  return ZernikePolynomial(noll).at(std::polar(rho, theta_rad));
}

PupilGrid pupil_grid(const Pupil& pupil, double wavelength_m, double cell_rad, int half,
                     double r0_m, int samples) {
  PupilGrid g;
  // The intensity spectrum ends at D / lambda: two samples for each lambda / D.
  const int fine = int(std::ceil(2.0 * pupil.aperture_m / wavelength_m * cell_rad));
  g.fine = std::max(1, fine + (fine + 1) % 2);
  // step = lambda / (side cell / fine): more samples make finer steps and a wider image.
  const double finest_m = std::min(pupil.aperture_m / samples, r0_m / 3);
  const double field_rad = std::max(2.0 * (2 * half + 1) * cell_rad, wavelength_m / finest_m);
  const int cells = good_fft_size(int(std::ceil(field_rad / cell_rad)), true);
  g.side = cells * g.fine;
  if (g.side > 8192)
    throw Error("pupil: turbulence too strong for the aperture, or cells too coarse");
  g.cell_rad = cell_rad;
  g.step_m = wavelength_m / (cells * cell_rad);
  return g;
}

int aperture_samples(const Pupil& pupil, const PupilGrid& grid) {
  return int(std::ceil(pupil.aperture_m / grid.step_m)) + 2;
}

namespace {

// Phase at sample (i, j) of the pupil's grid, steps of `ratio` screen samples.
double phase_of(const PhaseScreen& s, double ratio, int i, int j) {
  const double x = std::min(i * ratio, s.side - 1.0), y = std::min(j * ratio, s.side - 1.0);
  const int u = std::min(int(x), s.side - 2), v = std::min(int(y), s.side - 2);
  const double f = x - u, g = y - v;
  return (1 - g) * ((1 - f) * s.at(u, v) + f * s.at(u + 1, v)) +
         g * ((1 - f) * s.at(u, v + 1) + f * s.at(u + 1, v + 1));
}

// Complex amplitude over the aperture, in the first corner of `field` (n x n, zero before).
void fill_amplitude(const Pupil& pupil, const PupilGrid& grid, const ScreenAhead& ahead,
                    FftBuffer& field) {
  const int across = aperture_samples(pupil, grid), n = grid.side;
  const double step = grid.step_m / pupil.aperture_m;
  const double ratio = ahead.screen ? grid.step_m / ahead.step_m : 1.0;
  if (ahead.screen && ratio * (across - 3) > ahead.screen->side - 1)
    throw Error("pupil: the screen does not cover the aperture");
  std::vector<std::pair<double, ZernikePolynomial>> wavefront;
  for (const ZernikeTerm& t : pupil.wavefront)
    if (t.rms_rad != 0.0) wavefront.emplace_back(t.rms_rad, t.noll);
  for (int j = 0; j < across; ++j)
    for (int i = 0; i < across; ++i) {
      const double x = (i - 0.5 * (across - 1)) * step, y = (j - 0.5 * (across - 1)) * step;
      const double open = open_share(pupil, x, y, step);
      if (open == 0.0) continue;
      double phase = ahead.screen ? ahead.scale * phase_of(*ahead.screen, ratio, i, j) : 0.0;
      const std::complex<double> place =
          std::complex<double>(2 * x, 2 * y) / std::max(1.0, 2 * std::hypot(x, y));
      for (const auto& [rms_rad, polynomial] : wavefront) phase += rms_rad * polynomial.at(place);
      const auto at = 2 * (std::size_t(j) * std::size_t(n) + std::size_t(i));
      field.data()[at] = float(open * std::cos(phase));
      field.data()[at + 1] = float(open * std::sin(phase));
    }
}

}  // namespace

SampledOtf::SampledOtf(const PupilGrid& grid, const TransferFunction& otf)
    : side_(grid.side), values_(std::size_t(side_ / 2 + 1) * std::size_t(side_ / 2 + 1)) {
  const auto frequency = [&](int i) { return i * double(grid.fine) / (side_ * grid.cell_rad); };
  for (int y = 0; y <= side_ / 2; ++y)
    for (int x = 0; x <= side_ / 2; ++x) values_[place(x, y)] = otf(frequency(x), frequency(y));
}

PsfKernel pupil_kernel(const Pupil& pupil, const PupilGrid& grid, int half,
                       const ScreenAhead& ahead, const SampledOtf& extra) {
  const int n = grid.side;
  if (aperture_samples(pupil, grid) > n)
    throw Error("pupil: the grid is smaller than the aperture");
  FftBuffer field(2 * std::size_t(n) * std::size_t(n));
  fill_amplitude(pupil, grid, ahead, field);
  const ComplexFft2 fft(n);
  fft.transform(field);

  // Intensity, then its transfer function multiplied by the other blur, then back.
  double light = 0.0;
  for (std::size_t i = 0; i < field.size(); i += 2) {
    const double e = double(field.data()[i]) * field.data()[i] +
                     double(field.data()[i + 1]) * field.data()[i + 1];
    light += e;
    field.data()[i] = float(e);
    field.data()[i + 1] = 0.0f;
  }
  fft.transform(field);
  // Forward transform instead of inverse: mirrored, so conjugate first.
  const double scale = double(grid.fine) * grid.fine / (light * double(n) * n);
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      float* v = field.data() + 2 * (std::size_t(y) * std::size_t(n) + std::size_t(x));
      const double h = scale * extra.at(x, y);
      v[0] = float(v[0] * h);
      v[1] = float(-v[1] * h);
    }
  fft.transform(field);

  return kernel_in(field, n, grid.fine, half);
}

std::array<ZernikeTerm, 2> centring_tilt(const Pupil& pupil) {
  // Only terms of azimuthal order 1 have a mean slope; at radius rho their cosine (or sine) has the
  // amplitude zernike(noll, rho, 0 or 90 deg).
  std::array<ZernikeTerm, 2> tilt{{{2, 0.0}, {3, 0.0}}};
  const double e = pupil.obscuration;
  for (const ZernikeTerm& t : pupil.wavefront) {
    const auto [n, m] = noll_orders(t.noll);
    if (std::abs(m) != 1) continue;
    const double theta = m > 0 ? 0.0 : pi / 2;
    const double slope =
        (zernike(t.noll, 1.0, theta) - e * zernike(t.noll, e, theta)) / (1 - e * e);
    tilt[m > 0 ? 0 : 1].rms_rad -= 0.5 * t.rms_rad * slope;
  }
  return tilt;
}

}  // namespace dmise
