#include "sensors/planning/defocus_facts.h"

#include <algorithm>
#include <cmath>

namespace dmise {

DefocusFacts::DefocusFacts(const SensorConfig& sensor, SimTime middle)
    : optics_(sensor.camera.optics),
      plan_(plan_psf(optics_, sensor.camera.band.centre_m, sensor.seeing, sensor.exposure_s,
                     AirTurbulence::level(sensor.effects))),
      blurred_(blurred_by(plan_, optics_)),
      scale_(optics_, plan_),
      in_focus_m_(optics_.spread.defocus_m) {
  if (optics_.spread.drift.any() && sensor.effects.has(FocusDrift::facts))
    in_focus_m_ += optics_.spread.drift.at_m(middle.seconds());
}

double DefocusFacts::add(double range_m, double trail_px, PlanFacts& f) const {
  if (!f.scene.blurs) return 1.0;
  const double disc_px =
      scale_.disc_px(in_focus_m_ - range_defocus_m(optics_, std::max(range_m, 1e-3)));
  const double misplaced = scale_.misplaced(disc_px, scale_.disc_px(in_focus_m_));
  if (misplaced <= RangeDefocus::misplaced.back()) return 1.0;
  const PsfPlan plan = plan_defocused(blurred_, plan_.wavelength_m, plan_, std::abs(disc_px));
  constexpr double kernel_cell_s = 200e-9, tile_cell_s = 20e-9;
  const double cells = 4.0 * plan.half_cells * plan.half_cells;
  const double tiles = 1.0 + 2.0 * trail_px * plan.oversampling / plan.half_cells;
  const double cell_s = kernel_cell_s * std::max(1, plan.screens) + 5.0 * tile_cell_s * tiles;
  f.out_of_focus.push_back({misplaced, cells * cell_s});
  return std::sqrt(1.0 + disc_variance_px2(optics_, disc_px) / (f.sigma_px() * f.sigma_px()));
}

}  // namespace dmise
