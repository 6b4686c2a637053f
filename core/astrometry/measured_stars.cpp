#include "core/astrometry/measured_stars.h"

#include <algorithm>
#include <cmath>

#include "core/detection/frame_scene.h"
#include "core/detection/pixels/detection_limits.h"
#include "core/detection/source/scene.h"
#include "core/detection/source/source_fit.h"

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

}  // namespace dmise
