#include "core/calibration/star_sources.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "core/base/units.h"
#include "core/calibration/deblend.h"
#include "core/detection/background.h"
#include "core/detection/components.h"
#include "core/detection/trail_fit.h"

namespace dmise {
namespace {

constexpr double sigma_of_fwhm = 0.42466090014400953;
constexpr int most_component_px = 4000;  // more are no star
constexpr double longest_trail_px = 200.0;
constexpr double rise_of_a_star = 5.0;  // over a saddle, in noise of a pixel

double quantile_of(std::vector<double> values, double q) {
  const auto at = values.begin() + std::ptrdiff_t(q * double(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}
double median_of(std::vector<double> values) { return quantile_of(std::move(values), 0.5); }

/// An image's place, second moments and light, weighted by a Gaussian of these moments.
struct Moments {
  double x = 0.0, y = 0.0, flux = 0.0;
  double xx = 0.0, xy = 0.0, yy = 0.0;

  double mean() const { return 0.5 * (xx + yy); }
  double half() const { return std::hypot(0.5 * (xx - yy), xy); }
  double minor_sigma() const { return std::sqrt(std::max(mean() - half(), 1.0 / 12)); }
  double major_sigma() const { return std::sqrt(std::max(mean() + half(), 1.0 / 12)); }
  double angle_rad() const { return 0.5 * std::atan2(2 * xy, xx - yy); }
};

/// Length of the line that makes an image longer than wide.
double trail_length_px(const Moments& m, double sigma_px) {
  const double major = m.major_sigma();
  return std::sqrt(12 * std::max(0.0, major * major - sigma_px * sigma_px));
}

class SourceMeasure {
 public:
  SourceMeasure(const CountImage& counts, const Background& background,
                const StarSourceSettings& settings)
      : counts_(counts), background_(background), settings_(settings) {}

  double signal_e(int x, int y) const {
    return (counts_.at(x, y) - background_.level_dn(x, y)) * settings_.gain_e_per_dn;
  }

  double noise_e(int x, int y) const {
    return background_.sigma_dn(x, y) * settings_.gain_e_per_dn;
  }
  bool is_saturated(const Component& c) const {
    for (const Run& run : c.runs)
      for (int x = run.first_x; x <= run.last_x; ++x)
        if (saturated(x, run.y)) return true;
    return false;
  }
  double light_e(const Component& c) const {
    double sum = 0.0;
    for (const Run& run : c.runs)
      for (int x = run.first_x; x <= run.last_x; ++x) sum += signal_e(x, run.y);
    return sum;
  }

  std::optional<Moments> moments(const Component& c, double sigma_px) const {
    Moments m = of_component(c, sigma_px);
    for (int step = 0; step < 20; ++step) {
      const Moments before = m;
      if (!improve(m)) return std::nullopt;
      if (std::abs(m.x - before.x) + std::abs(m.y - before.y) < 1e-4 &&
          std::abs(m.xx - before.xx) + std::abs(m.yy - before.yy) < 1e-3 * m.mean())
        break;
    }
    if (m.x < c.min_x - 1 || m.x > c.max_x + 1 || m.y < c.min_y - 1 || m.y > c.max_y + 1)
      return std::nullopt;
    return m;
  }

  /// Fits a Gaussian of a width, or a line of it; empty if it does not converge.
  std::optional<TrailFit> fit(const Moments& m, double sigma_px) const;
  std::optional<PlateSource> source(const Moments& m, double sigma_px) const;
  PlateSource saturated_source(const Component& c, double sigma_px, double length_px) const;

 private:
  bool contains(int x, int y) const {
    return x >= 0 && y >= 0 && x < counts_.columns && y < counts_.rows;
  }
  bool saturated(int x, int y) const { return counts_.at(x, y) >= settings_.saturation_dn; }

  Moments of_component(const Component& c, double sigma_px) const {
    Moments m;
    double sum = 0.0;
    for (const Run& run : c.runs)
      for (int x = run.first_x; x <= run.last_x; ++x) {
        const double light = std::max(0.0, signal_e(x, run.y));
        sum += light;
        m.x += light * x;
        m.y += light * run.y;
        m.xx += light * x * x;
        m.yy += light * run.y * run.y;
        m.xy += light * x * run.y;
      }
    sum = std::max(sum, 1e-9);
    m.x /= sum;
    m.y /= sum;
    const double least = sigma_px * sigma_px;
    m.xx = std::max(m.xx / sum - m.x * m.x, least);
    m.yy = std::max(m.yy / sum - m.y * m.y, least);
    m.xy = std::clamp(m.xy / sum - m.x * m.y, -0.9 * std::sqrt(m.xx * m.yy),
                      0.9 * std::sqrt(m.xx * m.yy));
    return m;
  }

  /// One step of Bernstein & Jarvis' adaptive moments (2002, AJ 123, 583): of a Gaussian they are
  /// its own.
  bool improve(Moments& m) const {
    const double det = m.xx * m.yy - m.xy * m.xy;
    if (!(det > 1e-4) || m.mean() > longest_trail_px * longest_trail_px) return false;
    const double ixx = m.yy / det, ixy = -m.xy / det, iyy = m.xx / det;
    const int wide = int(std::ceil(3.5 * std::sqrt(m.xx))) + 1,
              high = int(std::ceil(3.5 * std::sqrt(m.yy))) + 1;
    const int cx = int(std::lround(m.x)), cy = int(std::lround(m.y));
    double sum = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0, syy = 0.0;
    for (int y = std::max(0, cy - high); y <= std::min(counts_.rows - 1, cy + high); ++y)
      for (int x = std::max(0, cx - wide); x <= std::min(counts_.columns - 1, cx + wide); ++x) {
        const double dx = x - m.x, dy = y - m.y;
        const double d2 = ixx * dx * dx + 2 * ixy * dx * dy + iyy * dy * dy;
        if (d2 > 12.25) continue;
        const double light = std::exp(-0.5 * d2) * signal_e(x, y);
        sum += light;
        sx += light * dx;
        sy += light * dy;
        sxx += light * dx * dx;
        sxy += light * dx * dy;
        syy += light * dy * dy;
      }
    if (!(sum > 0)) return false;
    sx /= sum;
    sy /= sum;
    m.x += 2 * sx;
    m.y += 2 * sy;
    m.xx = std::max(2 * (sxx / sum - sx * sx), 0.1);
    m.yy = std::max(2 * (syy / sum - sy * sy), 0.1);
    m.xy = 2 * (sxy / sum - sx * sy);
    m.flux = 2 * sum;  // the weight halves a Gaussian's light
    return std::isfinite(m.x + m.y) && contains(int(std::lround(m.x)), int(std::lround(m.y)));
  }

  const CountImage& counts_;
  const Background& background_;
  const StarSourceSettings& settings_;
};

/// The place is the middle of the light that is left; the flux is by the pixels just outside the
/// clipped ones.
PlateSource SourceMeasure::saturated_source(const Component& c, double sigma_px,
                                            double length_px) const {
  const Moments m = of_component(c, sigma_px);
  const Trail unit{
      .x_px = m.x, .y_px = m.y, .flux_e = 1.0, .length_px = length_px, .angle_rad = m.angle_rad()};
  std::vector<double> fluxes;
  for (int y = std::max(0, c.min_y - 1); y <= std::min(counts_.rows - 1, c.max_y + 1); ++y)
    for (int x = std::max(0, c.min_x - 1); x <= std::min(counts_.columns - 1, c.max_x + 1); ++x) {
      if (saturated(x, y)) continue;
      bool beside = false;
      for (const auto& [dx, dy] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}})
        beside = beside || (contains(x + dx, y + dy) && saturated(x + dx, y + dy));
      if (beside)
        fluxes.push_back(signal_e(x, y) / std::max(trail_value(unit, sigma_px, x, y), 1e-6));
    }
  const double light = light_e(c);
  const double flux = fluxes.empty() ? light : std::max(light, median_of(fluxes));
  return {m.x, m.y, flux, {0.25 * m.xx, 0.25 * m.xy, 0.25 * m.yy}, flux, true};
}

std::optional<TrailFit> SourceMeasure::fit(const Moments& m, double sigma_px) const {
  const double length = trail_length_px(m, sigma_px);
  const bool trail = length > 2 * sigma_px;
  Trail start{.x_px = m.x, .y_px = m.y, .flux_e = std::max(m.flux, 1.0)};
  if (trail) {
    start.length_px = length;
    start.angle_rad = m.angle_rad();
  }
  std::vector<FitPixel> pixels;
  const double c = std::cos(start.angle_rad), s = std::sin(start.angle_rad);
  const double across = 3 * sigma_px + 0.7, along = across + 0.6 * start.length_px;
  const int reach = int(std::ceil(along)) + 1;
  const int cx = int(std::lround(m.x)), cy = int(std::lround(m.y));
  for (int y = cy - reach; y <= cy + reach; ++y)
    for (int x = cx - reach; x <= cx + reach; ++x) {
      const double dx = x - m.x, dy = y - m.y;
      if (!contains(x, y) || std::abs(dx * c + dy * s) > along ||
          std::abs(dy * c - dx * s) > across)
        continue;
      const double noise = noise_e(x, y);
      pixels.push_back({x, y, float(signal_e(x, y)), float(noise * noise)});
    }
  if (pixels.size() < 12) return std::nullopt;
  // The background's error, as far as a mesh cell can hide it.
  const double prior_e = 0.3 * std::sqrt(double(pixels[0].variance_e2));
  const FitSettings fit_settings{.sigma_px = sigma_px, .background_sigma_e = prior_e};
  TrailFit fit = fit_trails(pixels, {start}, {trail ? trail_line : trail_place}, fit_settings);
  if (!fit.converged) fit = fit_trails(pixels, {start}, {trail_place}, fit_settings);
  if (!fit.converged) return std::nullopt;
  return fit;
}

std::optional<PlateSource> SourceMeasure::source(const Moments& m, double sigma_px) const {
  const auto fitted = fit(m, sigma_px);
  if (!fitted) return std::nullopt;
  const TrailFit& fit = *fitted;
  const Trail& t = fit.trails[0];
  if (!(t.flux_e > 0) || std::hypot(t.x_px - m.x, t.y_px - m.y) > 2 * m.major_sigma() ||
      !std::isfinite(fit.cov(0, 0) + fit.cov(1, 1)))
    return std::nullopt;
  const double scale = std::max(1.0, fit.reduced_chi2());
  const double flux_sigma = std::sqrt(scale * fit.cov(2, 2));
  if (t.flux_e < settings_.least_snr * flux_sigma) return std::nullopt;
  return PlateSource{t.x_px,
                     t.y_px,
                     t.flux_e,
                     {scale * fit.cov(0, 0), scale * fit.cov(0, 1), scale * fit.cov(1, 1)},
                     flux_sigma,
                     false};
}

/// Width of the Gaussian that fits images best, by golden section; the worse half may be blends.
double best_sigma_px(const SourceMeasure& measure,
                     std::span<const std::optional<Moments>> moments, double start_px) {
  constexpr std::size_t brightest = 400, most_images = 50;
  constexpr double golden = 0.6180339887498949;
  std::vector<Moments> images;
  for (const auto& m : moments)
    if (m && images.size() < brightest) images.push_back(*m);
  if (images.size() < 3) return start_px;
  const std::size_t every = (images.size() + most_images - 1) / most_images;
  for (std::size_t i = 0; i * every < images.size(); ++i) images[i] = images[i * every];
  images.resize((images.size() + every - 1) / every);
  const auto misfit = [&](double sigma_px) {
    std::vector<double> chi2;
    for (const Moments& m : images) {
      const auto fit = measure.fit(m, sigma_px);
      chi2.push_back(fit ? fit->reduced_chi2() : 1e9);
    }
    return quantile_of(std::move(chi2), 0.3);
  };
  double low = 0.75 * start_px, high = 1.5 * start_px;
  double a = high - golden * (high - low), b = low + golden * (high - low);
  double at_a = misfit(a), at_b = misfit(b);
  while (high - low > 0.004 * start_px) {
    if (at_a < at_b) {
      high = b;
      b = a;
      at_b = at_a;
      a = high - golden * (high - low);
      at_a = misfit(a);
    } else {
      low = a;
      a = b;
      at_a = at_b;
      b = low + golden * (high - low);
      at_b = misfit(b);
    }
  }
  return 0.5 * (low + high);
}

}  // namespace

std::vector<PlateSource> find_star_sources(const CountImage& counts,
                                           const StarSourceSettings& settings, Threads& threads) {
  const Background background(counts, 64, threads);
  const SourceMeasure measure(counts, background, settings);
  const double fwhm_px = settings.psf_fwhm_px > 0 ? settings.psf_fwhm_px : 2.0;
  const double filter_px = std::hypot(sigma_of_fwhm * fwhm_px, std::sqrt(1.0 / 12));
  const auto components =
      find_components(counts, background, filter_px, 3.0, settings.least_snr, threads);
  std::vector<std::pair<double, Component>> bright;
  for (const Component& c : components) {
    if (c.pixels > most_component_px) continue;
    const auto signal = [&](int x, int y) { return measure.signal_e(x, y); };
    const double noise_e = measure.noise_e(c.peak_x, c.peak_y);
    for (Component& part : deblend(c, {.least_rise = rise_of_a_star * noise_e}, signal)) {
      const double light_e = measure.light_e(part);
      bright.emplace_back(light_e, std::move(part));
    }
  }
  std::stable_sort(bright.begin(), bright.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  // The brightest, and as many of the next that are not saturated.
  std::size_t kept = 0, exact = 0;
  for (auto& part : bright) {
    const bool is_exact = !measure.is_saturated(part.second);
    if (kept >= settings.most && !is_exact) continue;
    if (exact >= settings.most) break;
    exact += is_exact;
    std::swap(bright[kept++], part);
  }
  bright.resize(kept);
  std::vector<std::optional<Moments>> moments(bright.size());
  std::vector<std::optional<PlateSource>> found(bright.size());
  const auto for_all = [&](const auto& work) {
    threads.for_ranges(bright.size(), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) work(i);
    });
  };
  const auto clipped = [&](std::size_t i) { return measure.is_saturated(bright[i].second); };
  for_all([&](std::size_t i) {
    if (!clipped(i)) moments[i] = measure.moments(bright[i].second, filter_px);
  });
  std::vector<double> widths, lengths;
  for (const auto& m : moments)
    if (m && widths.size() < 100) widths.push_back(m->minor_sigma());
  const double sigma_px =
      best_sigma_px(measure, moments, widths.empty() ? filter_px : median_of(widths));
  for (const auto& m : moments)
    if (m && lengths.size() < 500) lengths.push_back(trail_length_px(*m, sigma_px));
  const double length_px = lengths.empty() ? 0.0 : median_of(lengths);
  for_all([&](std::size_t i) {
    if (moments[i])
      found[i] = measure.source(*moments[i], sigma_px);
    else if (clipped(i))
      found[i] = measure.saturated_source(bright[i].second, sigma_px, length_px);
  });
  std::vector<PlateSource> sources;
  for (const auto& source : found)
    if (source) sources.push_back(*source);
  std::stable_sort(sources.begin(), sources.end(),
                   [](const PlateSource& a, const PlateSource& b) { return a.flux > b.flux; });
  return sources;
}

}  // namespace dmise
