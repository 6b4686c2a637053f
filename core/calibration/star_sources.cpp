#include "core/calibration/star_sources.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "core/base/quantile.h"
#include "core/base/units.h"
#include "core/calibration/deblend.h"
#include "core/calibration/source_measure.h"
#include "core/detection/background.h"
#include "core/detection/components.h"

namespace dmise {
namespace {

constexpr double sigma_of_fwhm = 0.42466090014400953;
constexpr int most_component_px = 4000;  // more are no star
constexpr double rise_of_a_star = 5.0;   // over a saddle, in noise of a pixel

/// Width of the Gaussian that fits images best, by golden section; the worse half may be blends.
double best_sigma_px(const SourceMeasure& measure,
                     std::span<const std::optional<SourceMoments>> moments, double start_px) {
  constexpr std::size_t brightest = 400, most_images = 50;
  constexpr double golden = 0.6180339887498949;
  std::vector<SourceMoments> images;
  for (const auto& m : moments)
    if (m && images.size() < brightest) images.push_back(*m);
  if (images.size() < 3) return start_px;
  const std::size_t every = (images.size() + most_images - 1) / most_images;
  for (std::size_t i = 0; i * every < images.size(); ++i) images[i] = images[i * every];
  images.resize((images.size() + every - 1) / every);
  const auto misfit = [&](double sigma_px) {
    std::vector<double> chi2;
    for (const SourceMoments& m : images) {
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
  std::vector<std::optional<SourceMoments>> moments(bright.size());
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
