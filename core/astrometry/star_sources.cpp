#include "core/astrometry/star_sources.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <span>

#include "core/astrometry/deblend.h"
#include "core/astrometry/source_measure.h"
#include "core/base/numeric/golden_section.h"
#include "core/base/numeric/quantile.h"
#include "core/base/units.h"
#include "core/detection/frame_scene.h"
#include "core/detection/pixels/background.h"
#include "core/detection/pixels/components.h"
#include "core/detection/pixels/detection_limits.h"
#include "core/detection/stars/trailed_stars.h"

namespace dmise {
namespace {

constexpr int max_component_px = 4000;  // more are no star
constexpr double rise_of_a_star = 5.0;  // over a saddle, in noise of a pixel

/// FWHM of a star before pixels widened it, about.
double fwhm_of(const StarSourceSettings& settings) {
  constexpr double usual_px = 2.0;
  return settings.psf_fwhm_px > 0 ? settings.psf_fwhm_px : usual_px;
}

/// Width of the Gaussian that fits images best, by golden section; the worse half may be blends.
double best_sigma_px(const SourceMeasure& measure,
                     std::span<const std::optional<SourceMoments>> moments, double start_px) {
  constexpr std::size_t brightest = 400, max_images = 200;
  std::vector<SourceMoments> images;
  for (const auto& m : moments)
    if (m && images.size() < brightest) images.push_back(*m);
  if (images.size() < 3) return start_px;
  const std::size_t every = (images.size() + max_images - 1) / max_images;
  for (std::size_t i = 0; i * every < images.size(); ++i) images[i] = images[i * every];
  images.resize((images.size() + every - 1) / every);
  const auto misfit = [&](double sigma_px) {
    double sum = 0.0;
    for (const SourceMoments& m : images) {
      const auto fit = measure.fit(m, sigma_px);
      sum += std::log(fit ? std::clamp(fit->reduced_chi2(), 0.5, 100.0) : 100.0);
    }
    return sum;
  };
  return golden_section(misfit, 0.75 * start_px, 1.5 * start_px, 0.004 * start_px).at;
}

/// Images that may be stars, the brightest first, and the width of most of them.
class StarImages {
 public:
  StarImages(const CountImage& counts, const StarSourceSettings& settings, Threads& threads);

  const SourceMeasure& measure() const { return measure_; }
  std::size_t size() const { return bright_.size(); }
  const Component& component(std::size_t i) const { return bright_[i].second; }
  bool clipped(std::size_t i) const { return measure_.is_saturated(bright_[i].second); }
  /// Empty for clipped images, and where there are none.
  const std::vector<std::optional<SourceMoments>>& moments() const { return moments_; }
  double sigma_px() const { return sigma_px_; }
  template <class Work>
  void for_all(const Work& work) const {
    threads_.for_ranges(bright_.size(), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) work(i);
    });
  }

 private:
  void find(const CountImage& counts, double filter_px, const StarSourceSettings& settings);
  void keep(std::size_t most);

  Background background_;
  SourceMeasure measure_;
  Threads& threads_;
  std::vector<std::pair<double, Component>> bright_;  // with its light [e-]
  std::vector<std::optional<SourceMoments>> moments_;
  double sigma_px_;
};

void StarImages::find(const CountImage& counts, double filter_px,
                      const StarSourceSettings& settings) {
  for (const Component& c :
       find_components(counts, background_, filter_px, 3.0, settings.min_snr, threads_)) {
    if (c.pixels > max_component_px) continue;
    const auto signal = [&](int x, int y) { return measure_.signal_e(x, y); };
    const double noise_e = measure_.noise_e(c.peak_x, c.peak_y);
    for (Component& part : deblend(c, rise_of_a_star * noise_e, signal)) {
      const double light_e = measure_.light_e(part);
      bright_.emplace_back(light_e, std::move(part));
    }
  }
  std::ranges::stable_sort(bright_, std::greater(), [](const auto& b) { return b.first; });
}

/// The brightest, and as many of the next that are not saturated.
void StarImages::keep(std::size_t most) {
  std::size_t kept = 0, exact = 0;
  for (auto& part : bright_) {
    const bool is_exact = !measure_.is_saturated(part.second);
    if (kept >= most && !is_exact) continue;
    if (exact >= most) break;
    exact += is_exact;
    std::swap(bright_[kept++], part);
  }
  bright_.resize(kept);
}

StarImages::StarImages(const CountImage& counts, const StarSourceSettings& settings,
                       Threads& threads)
    : background_(counts, 64, threads), measure_(counts, background_, settings), threads_(threads) {
  const double filter_px = sigma_with_pixel(fwhm_of(settings));
  find(counts, filter_px, settings);
  keep(settings.most);
  moments_.resize(bright_.size());
  for_all([&](std::size_t i) {
    if (!clipped(i)) moments_[i] = measure_.moments(bright_[i].second, filter_px);
  });
  std::vector<double> widths;
  for (const auto& m : moments_)
    if (m && !m->collapsed() && widths.size() < 100) widths.push_back(m->minor_sigma());
  sigma_px_ = best_sigma_px(measure_, moments_, widths.empty() ? filter_px : median_of(widths));
}

/// The middles of trails in a frame whose stars trail; none where they do not.
std::vector<PlateSource> sources_of_trails(const CountImage& counts,
                                           const StarSourceSettings& settings, Threads& threads) {
  const Background background(counts, detection_limits::background_cell_px, threads);
  const double fwhm_px = fwhm_of(settings);
  Scene scene{counts,
              background,
              *settings.motion,
              settings.gain_e_per_dn,
              settings.saturation_dn,
              sigma_with_pixel(fwhm_px),
              false,
              PsfField::gaussian(fwhm_px)};
  if (!stars_trail(scene)) return {};
  use_psf_of_stars(scene, threads);
  std::vector<PlateSource> sources;
  for (const TrailedStar& star : find_trailed_stars(scene))
    if (star.trail.flux_e > settings.min_snr * star.flux_sigma_e)
      sources.push_back({star.trail.x_px, star.trail.y_px, star.trail.flux_e, star.covariance_px2,
                         star.flux_sigma_e, false});
  std::ranges::stable_sort(sources, std::greater(), &PlateSource::flux);
  if (sources.size() > settings.most) sources.resize(settings.most);
  return sources;
}

/// The line of a fitted image; empty if it is round.
std::optional<StreakMotion> line_of_star(const TrailFit& fit) {
  constexpr int at_length = 3, at_angle = 4;
  constexpr int parameters = 6;  // a line has five, the background one
  if (!(fit.trails[0].length_px > 0) || fit.parameters < parameters) return std::nullopt;
  const double scale = std::max(1.0, fit.reduced_chi2());
  return streak_motion(fit.trails[0], scale * fit.cov(at_length, at_length),
                       scale * fit.cov(at_angle, at_angle));
}

}  // namespace

std::vector<PlateSource> find_star_sources(const CountImage& counts,
                                           const StarSourceSettings& settings, Threads& threads) {
  if (settings.motion && settings.unknown_mount)
    if (auto trails = sources_of_trails(counts, settings, threads); !trails.empty()) return trails;
  const StarImages images(counts, settings, threads);
  const SourceMeasure& measure = images.measure();
  const double sigma_px = images.sigma_px();
  std::vector<double> lengths;
  for (const auto& m : images.moments())
    if (m && lengths.size() < 500) lengths.push_back(trail_length_px(*m, sigma_px));
  const double length_px = lengths.empty() ? 0.0 : median_of(lengths);
  std::vector<std::optional<PlateSource>> found(images.size());
  images.for_all([&](std::size_t i) {
    if (images.moments()[i])
      found[i] = measure.source(*images.moments()[i], sigma_px);
    else if (images.clipped(i))
      found[i] = measure.saturated_source(images.component(i), sigma_px, length_px);
  });
  std::vector<PlateSource> sources;
  for (const auto& source : found)
    if (source) sources.push_back(*source);
  std::ranges::stable_sort(sources, std::greater(), &PlateSource::flux);
  return sources;
}

std::optional<StarShape> measure_star_shape(const CountImage& counts,
                                            const StarSourceSettings& settings, Threads& threads) {
  constexpr std::size_t least = 5, most = 200;
  constexpr double min_agreement = 0.8;  // length of the mean of unit vectors of twice the angle
  const StarImages images(counts, settings, threads);
  StarShape shape{.sigma_px = images.sigma_px()};
  std::vector<double> lengths;
  double c = 0.0, s = 0.0;
  for (const auto& m : images.moments()) {
    if (!m || lengths.size() >= most) continue;
    const auto fit = images.measure().fit(*m, images.sigma_px());
    if (!fit) continue;
    const Trail& trail = fit->trails[0];
    lengths.push_back(trail.length_px);
    if (const auto line = line_of_star(*fit)) shape.lines.push_back(*line);
    shape.ellipses.push_back({m->x, m->y, m->xx - m->yy, 2 * m->xy});
    if (trail.length_px > 0) {
      c += std::cos(2 * trail.angle_rad);
      s += std::sin(2 * trail.angle_rad);
    }
  }
  if (lengths.size() < least) return std::nullopt;
  shape.stars = int(lengths.size());
  const double length_px = median_of(lengths);
  if (length_px > 2 * shape.sigma_px && std::hypot(c, s) > min_agreement * double(lengths.size())) {
    shape.length_px = length_px;
    shape.angle_rad = 0.5 * std::atan2(s, c);
  }
  return shape;
}

}  // namespace dmise
