#include "core/astrometry/star_photometry.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/base/numeric/quantile.h"
#include "core/detection/frame_scene.h"
#include "core/detection/known/star_motion.h"
#include "core/detection/pixels/detection_limits.h"
#include "core/detection/source/scene.h"
#include "core/detection/source/source_fit.h"
#include "core/optics/camera.h"
#include "core/sky/air/airmass.h"
#include "core/sky/variables/variable_stars.h"

namespace dmise {
namespace {

constexpr double usual_fwhm_px = 2.0;  // for a header without one
/// Reach of wings in widths, and sources in it beyond which wings are not told from neighbours.
constexpr double wings = 10.0, most_within_wings = 0.5;

bool is_crowded(const Scene& scene, std::size_t sources) {
  const double wings_px = wings * scene.sigma_px;
  return double(sources) * pi * wings_px * wings_px >
         most_within_wings * scene.counts.columns * scene.counts.rows;
}

constexpr double common_error_mag = 0.01;   // error of the stars' light, equal for all
constexpr double gaussian_error_mag = 0.1;  // equal for all, by Gaussians: wings are 0 to 0.23 mag
constexpr double min_snr = 12.0;            // brighter stars are found however noise dims them
constexpr double low_deviations = 2.5;      // stars may be fainter by so much of their scatter
constexpr double max_shared = 0.1;          // light from neighbours, over a star's own
constexpr double max_airmass = 3.0;         // scintillation, haze and the band's width below
constexpr std::size_t enough_stars = 20;    // to do without others
constexpr std::size_t complete_sources = 1000;  // fewer were not cut off at a number

/// A matched star with its expected and its measured light.
struct Candidate {
  PhotometricStar star;
  double flux_e = 0.0, sky_e2 = 0.0;  // measured; variance without the star's photons
  double light = 1.0;                 // what the lens lets pass there, relative
  double shared_e = 0.0;              // from neighbours
};

double mag_of(double rate) { return -2.5 * std::log10(rate); }

/// Light of neighbours within a star's image, relative to its own.
class Neighbours {
 public:
  Neighbours(const FrameHeader& header, const PlateModel& model, const PlateSky& sky, int columns,
             int rows, double radius_rad, std::size_t most)
      : sigma_px_(std::hypot(0.4247 * (header.psf_fwhm_px > 0 ? header.psf_fwhm_px : 2.0),
                             std::sqrt(1.0 / 12))),
        motion_(header, columns, rows) {
    for (const SeenStar& s : sky.brightest(model.axis(), radius_rad, most))
      if (const auto at = model.pixel(s.direction)) stars_.push_back({s.index, *at, s.v_mag});
    std::ranges::stable_sort(stars_, {}, [](const Imaged& s) { return s.at.x_px; });
  }

  double share(const SeenStar& star, PixelPosition at) const {
    const PixelPosition trail = motion_.trail_at(at);
    const double length = std::hypot(trail.x_px, trail.y_px);
    const double c = length > 0 ? trail.x_px / length : 1.0,
                 s = length > 0 ? trail.y_px / length : 0.0;
    const double reach = length + 6 * sigma_px_;
    double sum = 0.0;
    for (auto i = std::ranges::lower_bound(stars_, at.x_px - reach, {},
                                           [](const Imaged& o) { return o.at.x_px; });
         i != stars_.end() && i->at.x_px < at.x_px + reach; ++i) {
      if (i->index == star.index) continue;
      const PixelPosition d = i->at - at;
      const double along = std::max(0.0, std::abs(d.x_px * c + d.y_px * s) - length);
      const double across = d.y_px * c - d.x_px * s;
      sum += std::pow(10.0, 0.4 * (star.v_mag - i->v_mag)) *
             std::exp(-(along * along + across * across) / (4 * sigma_px_ * sigma_px_));
    }
    return sum;
  }

 private:
  struct Imaged {
    std::uint32_t index;
    PixelPosition at;
    double v_mag;
  };
  double sigma_px_;
  StarMotion motion_;
  std::vector<Imaged> stars_;
};

/// The optics of which the header has a table of illumination.
Optics optics_of(const FrameHeader& header, const PlateModel& model, const CountImage& counts) {
  constexpr double pitch_m = 1e-5;  // any
  Optics optics{.projection = model.projection,
                .focal_length_m = model.focal_length_px * pitch_m,
                .pixel_pitch_m = pitch_m,
                .columns = counts.columns,
                .rows = counts.rows};
  optics.vignetting.table = header.illumination;
  optics.vignetting.table_radius = header.illumination_radius;
  return optics;
}

std::vector<Candidate> candidates_of(const Frame& frame, const PlateSolution& plate,
                                     std::span<const PlateSource> sources, const PlateSky& sky) {
  const PlateModel& model = plate.fit.model;
  const Optics optics = optics_of(frame.header, model, frame.counts);
  double radius_rad = 0.0;
  for (const PlateMatch& m : plate.matches)
    radius_rad = std::max(radius_rad, angle_rad(m.direction, model.axis()));
  const Neighbours neighbours(frame.header, model, sky, frame.counts.columns, frame.counts.rows,
                              radius_rad + 0.01, 60 * plate.matches.size());
  std::vector<Candidate> out;
  for (std::size_t k = 0; k < plate.matches.size(); ++k) {
    const PlateSource& source = sources[plate.matches[k].source];
    if (!plate.fit.used[k] || source.saturated) continue;
    const SeenStar& star = plate.stars[plate.matches[k].star];
    // A colour term by B-V is not that of red dwarfs and giants of type M.
    if (sky.map().stars.colour(star.index).kind != StarKind::most) continue;
    if (sky.map().variables && sky.map().variables->find(star.index)) continue;
    const PixelPosition at{source.x_px, source.y_px};
    const double light = relative_illumination(optics, at);
    if (!(light > 0)) continue;
    const double shared = neighbours.share(star, at);
    double x = 0.0;
    if (sky.air()) {
      const double sine = dot(star.direction, sky.air()->zenith);
      x = airmass(std::asin(std::clamp(sine, -1.0, 1.0)));
    }
    out.push_back({.star = {0.0, 0.0, star.v_mag, star.bv, x},
                   .flux_e = source.flux,
                   .sky_e2 = std::max(0.0, source.flux_sigma * source.flux_sigma - source.flux),
                   .light = light,
                   .shared_e = shared * source.flux});
  }
  if (out.empty()) return out;
  std::erase_if(out, [](const Candidate& c) { return c.shared_e > max_shared * c.flux_e; });
  for (Candidate& c : out) {
    c.star.instrumental_mag = mag_of(c.flux_e / (c.light * frame.header.exposure_s));
    c.star.sigma_mag = 2.5 / std::log(10.0) * std::sqrt(c.sky_e2 + c.flux_e) / c.flux_e;
  }
  if (std::ranges::count_if(out, [](const Candidate& c) {
        return c.star.airmass <= max_airmass;
      }) >= std::ptrdiff_t(enough_stars))
    std::erase_if(out, [](const Candidate& c) { return c.star.airmass > max_airmass; });
  return out;
}

/// Light below which sources were cut off, because there were more than are listed; negligible if
/// they were not.
double cut_e(std::span<const PlateSource> sources) {
  std::vector<double> fluxes;
  for (const PlateSource& s : sources)
    if (!s.saturated) fluxes.push_back(s.flux);
  return fluxes.size() < complete_sources ? 1e-9 : quantile_of(std::move(fluxes), 0.02);
}

}  // namespace

MeasuredStars light_by_psf(const Frame& frame, const FrameHeader& header,
                           std::span<const PlateSource> sources, const StarSourceSettings& settings,
                           Threads& threads) {
  const CountImage& counts = frame.counts;
  const Background background(counts, detection_limits::background_cell_px, threads);
  const StarMotion motion(header, counts.columns, counts.rows);
  const double fwhm_px = header.psf_fwhm_px > 0 ? header.psf_fwhm_px : usual_fwhm_px;
  Scene scene{counts,
              background,
              motion,
              settings.gain_e_per_dn,
              settings.saturation_dn,
              sigma_with_pixel(fwhm_px),
              header.detector && header.detector->blooming,
              PsfField::gaussian(fwhm_px),
              frame.unusable.pixels.empty() ? nullptr : &frame.unusable};
  use_psf_of_stars(scene, threads);
  MeasuredStars out{{sources.begin(), sources.end()},
                    scene.psf.stars > 0 && !is_crowded(scene, sources.size())};
  if (!out.by_psf) return out;
  threads.for_ranges(out.sources.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (PlateSource& s : std::span(out.sources).subspan(begin, end - begin)) {
      if (s.saturated) continue;
      Trail start = scene.star_trail(s.x_px, s.y_px);
      start.flux_e = s.flux;
      const auto fitted = fit_source(scene, start, start.length_px > 0, 0.0, false, trail_place);
      s.saturated = !fitted;
      if (!fitted) continue;
      s.flux = fitted->trail().flux_e;
      s.flux_sigma = std::sqrt(std::max(1.0, fitted->fit.reduced_chi2()) * fitted->fit.cov(2, 2));
    }
  });
  return out;
}

std::optional<ZeroPoint> zero_point_of(const Frame& frame, const PlateSolution& plate,
                                       const MeasuredStars& light, const PlateSky& sky) {
  if (frame.header.unknown.has(FrameFact::exposure)) return std::nullopt;
  std::vector<Candidate> candidates = candidates_of(frame, plate, light.sources, sky);
  std::optional<double> believed = sky.air() ? frame.header.extinction_mag_per_airmass : 0.0;
  if (sky.air() && frame.header.unknown.has(FrameFact::extinction)) believed.reset();
  const double listed_e = cut_e(light.sources);
  std::vector<PhotometricStar> stars;
  for (const Candidate& c : candidates) stars.push_back(c.star);
  auto z = fit_zero_point(stars, believed);
  for (int pass = 0; pass < 5 && z; ++pass) {
    stars.clear();
    std::vector<double> margins;  // over the least light that is taken
    for (Candidate& c : candidates) {
      const double excess_mag = c.star.v_mag - c.star.instrumental_mag - z->zero_point_mag -
                                z->colour_term * (c.star.bv - ZeroPoint::sunlike_bv) +
                                z->extinction_mag_per_airmass * c.star.airmass;
      const double expected_e = c.flux_e * std::pow(10.0, -0.4 * excess_mag);
      const double snr = expected_e / std::sqrt(c.sky_e2 + expected_e);
      c.star.sigma_mag = 2.5 / std::log(10.0) / snr;
      const double fainter = std::pow(10.0, -0.4 * low_deviations * z->scatter_mag(c.star.airmass));
      margins.push_back(std::min(snr / min_snr, expected_e / listed_e) * fainter);
    }
    std::vector<double> sorted = margins;
    std::ranges::sort(sorted, std::greater());
    double limit = 1.0;  // lower where there are few stars
    if (!sorted.empty()) limit = std::min(limit, sorted[std::min(sorted.size(), enough_stars) - 1]);
    for (std::size_t i = 0; i < candidates.size(); ++i)
      if (margins[i] >= limit) stars.push_back(candidates[i].star);
    const auto next = fit_zero_point(stars, believed);
    if (!next) break;
    z = next;
  }
  const double common_mag = light.by_psf ? common_error_mag : gaussian_error_mag;
  if (z) z->covariance[0][0] += common_mag * common_mag;
  return z;
}

}  // namespace dmise
