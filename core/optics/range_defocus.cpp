#include "core/optics/range_defocus.h"

#include <algorithm>
#include <cmath>

#include "core/effects/plan_facts.h"
#include "core/optics/psf_plan.h"

namespace dmise {

ErrorBound RangeDefocus::error(int level, const PlanFacts& f) {
  if (level == facts.reference() || f.out_of_focus.empty()) return {};
  const double bound = misplaced[std::size_t(level)];
  double most = 0.0;
  for (const auto& object : f.out_of_focus) most = std::max(most, object.misplaced);
  return f.misplaced(std::min(bound, most), 0.0);
}

double RangeDefocus::cost_s(int level, const PlanFacts& f) {
  double sum_s = 0.0;
  for (const auto& object : f.out_of_focus)
    if (level > 0 && object.misplaced > misplaced[std::size_t(level)]) sum_s += object.cost_s;
  return sum_s;
}

double range_defocus_m(const Optics& optics, double range_m) {
  return optics.focal_length_m * optics.focal_length_m / range_m;
}

double disc_variance_px2(const Optics& optics, double disc_px) {
  return (1.0 + optics.obscuration * optics.obscuration) * disc_px * disc_px / 16.0;
}

DefocusScale::DefocusScale(const Optics& optics, const PsfPlan& in_focus)
    : px_per_m_(1.0 / optics.f_number() / optics.pixel_pitch_m) {
  const double e2 = optics.obscuration * optics.obscuration;
  const double own_px = optics.spread.defocus_m * px_per_m_;
  constexpr double pixel_px = 0.5;
  const double focused2 = std::max(0.0, in_focus.fwhm_px * in_focus.fwhm_px - own_px * own_px);
  width_px_ = std::hypot(std::sqrt(focused2), pixel_px);
  ring_ = (1.0 + e2) / (1.0 - e2);
  constexpr double blurred_away = 4.0;
  airy_px_ = in_focus.wavelength_m / optics.aperture_m / optics.pixel_angle_rad();
  if (optics.spread.model != PointSpread::Model::diffraction || width_px_ > blurred_away * airy_px_)
    airy_px_ = 0.0;
}

double DefocusScale::disc_px(double defocus_m) const {
  return std::clamp(defocus_m * px_per_m_, -widest_disc_px, widest_disc_px);
}

// A disc of d adds d^2 / 16 to the variance of the blur; a share of no more than half of
// d^2 / width^2 is misplaced by one much narrower, of the ratio of areas by one much wider. The
// rings of diffraction are moved by the rms of the wavefront's change, 0.2267 rad per lambda / D
// in the disc.
double DefocusScale::measure(double disc_px) const {
  const double widths = disc_px / width_px_;
  const double of_disc = ring_ * std::log1p(widths * widths);
  if (airy_px_ == 0.0) return of_disc;
  const double rings = std::abs(disc_px) / airy_px_;
  return of_disc + 0.2267 * rings * rings / (1.0 + rings);
}

double DefocusScale::misplaced(double disc_px, double other_px) const {
  if (disc_px * other_px < 0.0) return misplaced(disc_px, 0.0) + misplaced(0.0, other_px);
  return std::min(1.0, std::abs(measure(disc_px) - measure(other_px)));
}

double DefocusScale::stepped_m(double defocus_m, double in_focus_m, double share) const {
  const double disc_px = this->disc_px(defocus_m), in_focus_px = this->disc_px(in_focus_m);
  if (misplaced(disc_px, in_focus_px) <= share) return in_focus_m;
  const double step = 2.0 * share;
  const double middle = step * std::round(measure(disc_px) / step);
  double least = 0.0, most = 2.0 * std::abs(disc_px) + width_px_;
  for (int halving = 0; halving < 60; ++halving) {
    const double half = 0.5 * (least + most);
    (measure(half) < middle ? least : most) = half;
  }
  return std::copysign(std::min(least, widest_disc_px), disc_px) / px_per_m_;
}

}  // namespace dmise
