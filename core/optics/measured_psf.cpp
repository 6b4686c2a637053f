#include "core/optics/measured_psf.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "core/base/error.h"
#include "core/base/formatted.h"
#include "core/base/units.h"

namespace dmise {
namespace {

/// Neighbours of a value in a sorted list, and the weight of the second.
struct Between {
  std::size_t first = 0, second = 0;
  double share = 0.0;
};
Between between(const std::vector<double>& sorted, double value) {
  if (sorted.size() < 2 || value <= sorted.front()) return {};
  if (value >= sorted.back()) return {sorted.size() - 1, sorted.size() - 1, 0.0};
  const auto above =
      std::size_t(std::upper_bound(sorted.begin(), sorted.end(), value) - sorted.begin());
  const double low = sorted[above - 1], high = sorted[above];
  return {above - 1, above, (value - low) / (high - low)};
}

/// The values in ascending order, each once; those of no plane: one, of all.
template <class Value>
std::vector<double> axis_of(const std::vector<MeasuredPsf::Plane>& planes, const Value& value_of) {
  std::vector<double> values;
  for (const auto& plane : planes)
    if (const std::optional<double> value = value_of(plane)) values.push_back(*value);
  if (!values.empty() && values.size() != planes.size())
    throw Error("some planes have a place or wavelength and some have none");
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  if (values.empty()) values.push_back(0.0);
  return values;
}

std::size_t index_of(const std::vector<double>& axis, double value) {
  return std::size_t(std::lower_bound(axis.begin(), axis.end(), value) - axis.begin());
}

std::set<double> ends_of(const std::vector<double>& sorted) {
  return {sorted.front(), sorted.back()};
}

/// Complex numbers, rows x columns, as two arrays: compilers work on several at a time.
struct Field {
  std::size_t columns = 0;
  std::vector<double> re, im;

  Field(std::size_t rows, std::size_t columns)
      : columns(columns), re(rows * columns), im(rows * columns) {}
  /// Adds (re + i im) times the row `from` of `other` to the row `to`.
  void add(std::size_t to, double factor_re, double factor_im, const Field& other,
           std::size_t from) {
    double* const r = re.data() + to * columns;
    double* const i = im.data() + to * columns;
    const double* const other_r = other.re.data() + from * columns;
    const double* const other_i = other.im.data() + from * columns;
    for (std::size_t k = 0; k < columns; ++k) {
      r[k] += factor_re * other_r[k] - factor_im * other_i[k];
      i[k] += factor_re * other_i[k] + factor_im * other_r[k];
    }
  }
};

/// exp(-2 pi i nu x) for `count` places x, `step` apart about 0: places x frequencies.
Field waves(const std::vector<double>& nu, int count, double step) {
  Field waves{std::size_t(count), nu.size()};
  for (int i = 0; i < count; ++i)
    for (std::size_t m = 0; m < nu.size(); ++m) {
      const double phase = -2.0 * pi * nu[m] * (i - 0.5 * (count - 1)) * step;
      waves.re[std::size_t(i) * nu.size() + m] = std::cos(phase);
      waves.im[std::size_t(i) * nu.size() + m] = std::sin(phase);
    }
  return waves;
}

/// The transform of rows x columns values at all pairs of frequencies, along x, then along y.
Field transform(const std::vector<double>& image, int columns, int rows, double step,
                const std::vector<double>& nu_x, const std::vector<double>& nu_y) {
  const Field wave_x = waves(nu_x, columns, step), wave_y = waves(nu_y, rows, step);
  Field along_x{std::size_t(rows), nu_x.size()};
  for (std::size_t y = 0; y < std::size_t(rows); ++y)
    for (std::size_t x = 0; x < std::size_t(columns); ++x)
      along_x.add(y, image[y * std::size_t(columns) + x], 0.0, wave_x, x);
  Field all{nu_y.size(), nu_x.size()};
  for (std::size_t n = 0; n < nu_y.size(); ++n)
    for (std::size_t y = 0; y < std::size_t(rows); ++y)
      all.add(n, wave_y.re[y * nu_y.size() + n], wave_y.im[y * nu_y.size() + n], along_x, y);
  return all;
}

/// Frequencies from -most to most, or from 0, in steps.
std::vector<double> frequencies(double most, double step, bool from_zero) {
  const int last = int(std::floor(most / step * (1.0 + 1e-12)));
  std::vector<double> nu;
  for (int i = from_zero ? 0 : -last; i <= last; ++i) nu.push_back(i * step);
  return nu;
}

}  // namespace

MeasuredPsf::MeasuredPsf(int columns, int rows, double samples_per_px, bool with_pixel,
                         std::vector<Plane> planes, std::string digest)
    : columns_(columns),
      rows_(rows),
      samples_per_px_(samples_per_px),
      with_pixel_(with_pixel),
      x_px_(axis_of(
          planes, [](const Plane& p) { return p.at ? std::optional(p.at->x_px) : std::nullopt; })),
      y_px_(axis_of(
          planes, [](const Plane& p) { return p.at ? std::optional(p.at->y_px) : std::nullopt; })),
      wavelengths_m_(axis_of(planes, [](const Plane& p) { return p.wavelength_m; })),
      digest_(std::move(digest)) {
  const std::size_t wanted = x_px_.size() * y_px_.size() * wavelengths_m_.size();
  if (planes.size() != wanted)
    throw Error(formatted("places must be a grid with all wavelengths, %zu planes, got %zu", wanted,
                          planes.size()));
  images_.resize(wanted);
  for (Plane& plane : planes) {
    const double sum = std::accumulate(plane.values.begin(), plane.values.end(), 0.0);
    if (!(sum > 0.0) || !std::isfinite(sum))
      throw Error(formatted("the sum of an image must be above 0, got %g", sum));
    for (double& value : plane.values) value /= sum;
    const std::size_t w = plane.wavelength_m ? index_of(wavelengths_m_, *plane.wavelength_m) : 0;
    const std::size_t x = plane.at ? index_of(x_px_, plane.at->x_px) : 0;
    const std::size_t y = plane.at ? index_of(y_px_, plane.at->y_px) : 0;
    auto& image = images_[(w * y_px_.size() + y) * x_px_.size() + x];
    if (!image.empty()) throw Error("two planes have the same place and wavelength");
    image = std::move(plane.values);
  }
  measure();
}

double MeasuredPsf::reach_px() const { return 0.5 * std::max(columns_, rows_) / samples_per_px_; }

std::vector<double> MeasuredPsf::image_at(PixelPosition at, double wavelength_m) const {
  const Between w = between(wavelengths_m_, wavelength_m);
  const Between x = between(x_px_, at.x_px), y = between(y_px_, at.y_px);
  std::vector<double> sum(std::size_t(columns_) * std::size_t(rows_));
  const auto add = [&](std::size_t iw, std::size_t iy, std::size_t ix, double share) {
    if (share == 0.0) return;
    const auto& image = images_[(iw * y_px_.size() + iy) * x_px_.size() + ix];
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += share * image[i];
  };
  for (const auto& [iw, sw] : {std::pair(w.first, 1.0 - w.share), {w.second, w.share}})
    for (const auto& [iy, sy] : {std::pair(y.first, 1.0 - y.share), {y.second, y.share}})
      for (const auto& [ix, sx] : {std::pair(x.first, 1.0 - x.share), {x.second, x.share}})
        add(iw, iy, ix, sw * sy * sx);
  return sum;
}

void MeasuredPsf::measure() {
  const auto image =
      image_at({0.5 * (x_px_.front() + x_px_.back()), 0.5 * (y_px_.front() + y_px_.back())},
               0.5 * (wavelengths_m_.front() + wavelengths_m_.back()));
  const double half = 0.5 * *std::max_element(image.begin(), image.end());
  const auto bright =
      std::count_if(image.begin(), image.end(), [&](double v) { return v >= half; });
  fwhm_px_ = std::sqrt(4.0 / pi * double(bright)) / samples_per_px_;

  cutoff_per_px_ = 0.0;
  for (const double w : ends_of(wavelengths_m_))
    for (const double y : ends_of(y_px_))
      for (const double x : ends_of(x_px_))
        cutoff_per_px_ = std::max(cutoff_per_px_, cutoff_of(image_at({x, y}, w)));
}

double MeasuredPsf::cutoff_of(const std::vector<double>& image) const {
  constexpr double little = 3e-4;
  const double step = 1.0 / (2.0 * reach_px()), end = 0.5 * samples_per_px_;
  const auto nu_x = frequencies(end, step, true), nu_y = frequencies(end, step, false);
  const Field otf = transform(image, columns_, rows_, 1.0 / samples_per_px_, nu_x, nu_y);
  double cutoff = step;
  for (std::size_t n = 0; n < nu_y.size(); ++n)
    for (std::size_t m = 0; m < nu_x.size(); ++m)
      if (const std::size_t i = n * nu_x.size() + m; std::hypot(otf.re[i], otf.im[i]) > little)
        cutoff = std::max({cutoff, nu_x[m], std::abs(nu_y[n])});
  return std::min(cutoff, end);
}

PsfKernel MeasuredPsf::kernel(PixelPosition at, double wavelength_m, int cells_per_px,
                              int half_cells, const TransferFunction& more) const {
  const auto image = image_at(at, wavelength_m);
  // A period in which neither the image nor the kernel meets itself.
  const int side = 2 * half_cells + 1;
  const double period_px = 2.0 * reach_px() + double(side) / cells_per_px;
  const double end = 0.5 * std::min(samples_per_px_, double(cells_per_px));
  const auto nu_x = frequencies(end, 1.0 / period_px, true);
  const auto nu_y = frequencies(end, 1.0 / period_px, false);
  Field otf = transform(image, columns_, rows_, 1.0 / samples_per_px_, nu_x, nu_y);
  for (std::size_t n = 0; n < nu_y.size(); ++n)
    for (std::size_t m = 0; m < nu_x.size(); ++m) {
      // Real images: what is left of x = 0 is the conjugate of what is right of it.
      const double factor = (m == 0 ? 1.0 : 2.0) * more(nu_x[m], nu_y[n]);
      otf.re[n * nu_x.size() + m] *= factor;
      otf.im[n * nu_x.size() + m] *= factor;
    }
  const double cell_px = 1.0 / cells_per_px;
  const Field wave_x = waves(nu_x, side, cell_px), wave_y = waves(nu_y, side, cell_px);
  Field along_y{std::size_t(side), nu_x.size()};
  for (std::size_t y = 0; y < std::size_t(side); ++y)
    for (std::size_t n = 0; n < nu_y.size(); ++n)
      along_y.add(y, wave_y.re[y * nu_y.size() + n], -wave_y.im[y * nu_y.size() + n], otf, n);
  PsfKernel kernel{half_cells, std::vector<float>(std::size_t(side) * std::size_t(side))};
  std::vector<double> values(kernel.values.size());
  for (std::size_t y = 0; y < std::size_t(side); ++y)
    for (std::size_t x = 0; x < std::size_t(side); ++x) {
      const std::size_t row = y * nu_x.size(), wave = x * nu_x.size();
      double value = 0.0;
      for (std::size_t m = 0; m < nu_x.size(); ++m)
        value +=
            along_y.re[row + m] * wave_x.re[wave + m] + along_y.im[row + m] * wave_x.im[wave + m];
      values[y * std::size_t(side) + x] = value;
    }
  double sum = 0.0;
  const auto taper = [&](int offset) {
    const double inside = half_cells + 1 - std::abs(offset);
    if (inside > margin_cells) return 1.0;
    const double s = std::sin(0.5 * pi * inside / (margin_cells + 1));
    return s * s;
  };
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      sum += values[std::size_t(y) * std::size_t(side) + std::size_t(x)] *=
          taper(x - half_cells) * taper(y - half_cells);
  for (std::size_t i = 0; i < values.size(); ++i) kernel.values[i] = float(values[i] / sum);
  return kernel;
}

}  // namespace dmise
