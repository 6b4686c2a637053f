#include "core/detection/stars/star_agreement.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/numeric/quantile.h"
#include "core/detection/pixels/components.h"
#include "core/detection/source/source_fit.h"

namespace dmise {
namespace {

constexpr double looked_for_snr = 8.0;  // brighter stars must be seen if there are no clouds
constexpr double crowded_snr = 200.0;   // brighter ones are saturated, or wide
constexpr double measured_snr = 12.0;   // brighter stars have their light measured
constexpr double seen_snr = 3.0;
constexpr double max_shift_px = 2.5;
constexpr std::size_t enough_stars = 5;   // to measure a shift, or light
constexpr int cells = 12;                 // rows, and columns, of the mesh of light
constexpr std::size_t most_in_cell = 16;  // stars whose light is measured there

/// Middle of the light above the noise around a place; empty if there is none near.
std::optional<PixelPosition> centroid_near(const FilteredFrame& frame, PixelPosition at,
                                           double reach_px) {
  const int reach = int(std::ceil(reach_px));
  const int cx = int(std::lround(at.x_px)), cy = int(std::lround(at.y_px));
  double sum = 0.0, x = 0.0, y = 0.0;
  for (int py = std::max(0, cy - reach); py <= std::min(frame.rows - 1, cy + reach); ++py)
    for (int px = std::max(0, cx - reach); px <= std::min(frame.columns - 1, cx + reach); ++px) {
      const int v = frame.row(py)[px];
      if (v < int(seen_snr * FilteredFrame::steps)) continue;
      sum += v;
      x += v * (px - at.x_px);
      y += v * (py - at.y_px);
    }
  if (!(sum > 0)) return std::nullopt;
  return PixelPosition{x / sum, y / sum};
}

/// The ratio and scatter of logarithms.
StarLightRatio ratio_of(const std::vector<double>& logs) {
  const double middle = quantile_of(logs, 0.5);
  const double scatter = (quantile_of(logs, 0.75) - quantile_of(logs, 0.25)) / 1.349;
  return {std::exp(middle), std::max(scatter, 0.1)};
}

/// SNR of a star's middle in the frame through the filter. `unit`: root of the kernel's square sum.
double peak_snr(const Scene& scene, const FilteredFrame& frame, double unit, const Trail& trail,
                double signal_e) {
  Trail lit = trail;
  lit.flux_e = signal_e;
  const double noise_e = scene.noise_e_at(trail.x_px, trail.y_px);
  const double sigma_px = std::hypot(scene.sigma_px, frame.sigma_px);
  return trail_value(lit, sigma_px, trail.x_px, trail.y_px) / (unit * noise_e);
}

bool is_inside(const Scene& scene, PixelPosition place) {
  return place.x_px >= 0 && place.y_px >= 0 && place.x_px <= scene.counts.columns - 1 &&
         place.y_px <= scene.counts.rows - 1;
}

}  // namespace

StarAgreement::StarAgreement(const Scene& scene, const FilteredFrame& frame,
                             const std::vector<ExpectedStar>& stars)
    : columns_(frame.columns), rows_(frame.rows), light_(std::size_t(cells * cells)) {
  std::vector<double> dx, dy;
  const double unit = std::sqrt(kernel_square_sum(frame.sigma_px));
  for (const ExpectedStar& star : stars) {
    if (star.varies() || !is_inside(scene, star.place)) continue;
    const Trail trail = scene.star_trail(star.place.x_px, star.place.y_px);
    const double peak = peak_snr(scene, frame, unit, trail, star.signal_e);
    if (peak < looked_for_snr) continue;
    ++seen_.expected;
    const auto off =
        centroid_near(frame, star.place, trail.length_px / 2 + 2 * scene.sigma_px + max_shift_px);
    if (!off || std::hypot(off->x_px, off->y_px) > max_shift_px) continue;
    ++seen_.found;
    if (peak > crowded_snr) continue;
    dx.push_back(off->x_px);
    dy.push_back(off->y_px);
  }
  if (dx.size() >= enough_stars) {
    seen_.shift = {quantile_of(dx, 0.5), quantile_of(dy, 0.5)};
    std::vector<double> apart;
    for (std::size_t i = 0; i < dx.size(); ++i)
      apart.push_back(std::hypot(dx[i] - seen_.shift.x_px, dy[i] - seen_.shift.y_px));
    // The median of a distance in the plane is 1.18 standard deviations of one axis.
    seen_.scatter_px = std::max(0.1, quantile_of(std::move(apart), 0.5) / 1.18);
  }
  measure_light(scene, frame, stars);
}

void StarAgreement::measure_light(const Scene& scene, const FilteredFrame& frame,
                                  const std::vector<ExpectedStar>& stars) {
  constexpr double min_ratio = 0.02;  // behind clouds
  std::vector<std::vector<double>> logs(light_.size());
  std::vector<double> all;
  const double unit = std::sqrt(kernel_square_sum(frame.sigma_px));
  for (const ExpectedStar& star : stars) {
    const PixelPosition at = star.place + seen_.shift;
    if (star.varies() || !is_inside(scene, at)) continue;
    auto& measured = logs[cell_of(at)];
    if (measured.size() == most_in_cell) continue;
    Trail trail = scene.star_trail(at.x_px, at.y_px);
    const double peak = peak_snr(scene, frame, unit, trail, star.signal_e);
    if (peak < measured_snr || peak > crowded_snr) continue;
    trail.flux_e = 1.0;
    const auto pixels = pixels_near(scene, trail, 2 * scene.sigma_px + 0.5);
    const std::vector<double> shape = light_in(pixels, {&trail, 1}, scene.psf.at(at));
    double sum = 0.0, squares = 0.0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      sum += shape[i] * pixels[i].signal_e;
      squares += shape[i] * shape[i];
    }
    if (!(squares > 0)) continue;
    const double ratio = std::max(sum / squares / star.signal_e, min_ratio);
    measured.push_back(std::log(ratio));
    all.push_back(std::log(ratio));
  }
  if (all.size() < enough_stars) return;
  const StarLightRatio mean = ratio_of(all);
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i) {
      std::vector<double> around;
      for (int y = std::max(0, j - 1); y <= std::min(cells - 1, j + 1); ++y)
        for (int x = std::max(0, i - 1); x <= std::min(cells - 1, i + 1); ++x) {
          const auto& some = logs[std::size_t(y * cells + x)];
          around.insert(around.end(), some.begin(), some.end());
        }
      light_[std::size_t(j * cells + i)] = around.size() < enough_stars ? mean : ratio_of(around);
    }
}

std::size_t StarAgreement::cell_of(PixelPosition place) const {
  const int i = int(std::clamp(place.x_px * cells / columns_, 0.0, cells - 1.0));
  const int j = int(std::clamp(place.y_px * cells / rows_, 0.0, cells - 1.0));
  return std::size_t(j * cells + i);
}

const StarLightRatio& StarAgreement::light_at(PixelPosition place) const {
  return light_[cell_of(place)];
}

}  // namespace dmise
