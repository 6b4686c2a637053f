#include "core/detection/source/template_snr.h"

#include <cmath>
#include <vector>

#include "core/detection/pixels/components.h"
#include "core/detection/source/line_search.h"
#include "core/detection/source/source_fit.h"

namespace dmise {
namespace {

constexpr double margin_in_sigmas = 2.5;
constexpr double spare_px = 3.0;  // by which a trail may move while it is matched

double snr_of(const Scene& scene, const std::vector<FitPixel>& pixels, Trail trail) {
  trail.flux_e = 1.0;
  const StarlitSky sky = starlit_sky(scene, trail);
  const std::vector<double> shape =
      light_in(pixels, {&trail, 1}, scene.psf.at({trail.x_px, trail.y_px}));
  double sum = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const FitPixel& p = pixels[i];
    const double g = shape[i];
    const double sky_e = sky.level * std::sqrt(double(p.variance_e2));
    sum += g * (p.signal_e - sky_e) / p.variance_e2;
    squares += g * g / p.variance_e2;
  }
  return squares > 0 ? sum / std::sqrt(squares) / sky.scatter : 0.0;
}

}  // namespace

StarlitSky starlit_sky(const Scene& scene, const Trail& trail) {
  if (!scene.flat) return {};
  const FilteredFrame::Cell cell = scene.flat->cell_at(trail.x_px, trail.y_px);
  return {double(cell.middle) / FilteredFrame::steps *
              std::sqrt(kernel_square_sum(scene.flat->sigma_px)),
          double(cell.scatter)};
}

double template_snr(const Scene& scene, const Trail& trail) {
  return snr_of(scene, pixels_near(scene, trail, margin_in_sigmas * scene.sigma_px + 0.5), trail);
}

TemplateMatch best_template(const Scene& scene, const Trail& start) {
  const auto pixels = pixels_near(scene, start, margin_in_sigmas * scene.sigma_px + 0.5 + spare_px);
  TemplateMatch best{start, snr_of(scene, pixels, start)};
  for (double step_px = 1.0; step_px > 0.2; step_px /= 2)
    for (bool better = true; better;) {
      better = false;
      for (const auto what : {TrailChange::offset, TrailChange::direction, TrailChange::first_end,
                              TrailChange::last_end})
        for (const double side : {1.0, -1.0}) {
          const Trail trial = changed(best.trail, what, side * step_px);
          if (std::hypot(trial.x_px - start.x_px, trial.y_px - start.y_px) > spare_px ||
              std::abs(trial.length_px - start.length_px) > 2 * spare_px)
            continue;
          const double snr = snr_of(scene, pixels, trial);
          if (!(snr > best.snr)) continue;
          best = {trial, snr};
          better = true;
          break;
        }
    }
  return best;
}

}  // namespace dmise
