#include "core/detector/dark_current.h"

#include <cmath>

#include "core/detector/detector.h"
#include "core/effects/plan_facts.h"

namespace dmise {
namespace {

constexpr double absolute_zero_c = -273.15, hottest_c = 100.0;
constexpr double max_e_per_s = 1e9;

}  // namespace

ErrorBound DarkCurrent::error(int, const PlanFacts& f) { return f.without_charge(f.dark_e); }

double DarkCurrent::thermal_factor() const {
  return dark_doubling_k > 0.0 ? std::exp2((temperature_c - dark_reference_c) / dark_doubling_k)
                               : 1.0;
}

std::span<const ParameterOf<DarkCurrent>> DarkCurrent::parameters() {
  static constexpr ParameterOf<DarkCurrent> table[] = {
      {"dark_e_per_s", "", "[e-/s] dark current at dark_reference_c", &DarkCurrent::dark_e_per_s,
       0.0, max_e_per_s},
      {"dark_reference_c", "DARKREFT", "[deg C] where dark currents are known",
       &DarkCurrent::dark_reference_c, absolute_zero_c, hottest_c},
      {"temperature_c", "DET-TEMP", "[deg C] of the detector", &DarkCurrent::temperature_c,
       absolute_zero_c, hottest_c},
      {"dark_doubling_k", "DARKDBL", "[K] warming that doubles dark current",
       &DarkCurrent::dark_doubling_k, 0.0, 100.0}};
  return table;
}

std::optional<DetectorFault> DarkCurrent::fault(const Detector& d) {
  if (d.dark_doubling_k != 0.0 && !(d.dark_doubling_k >= 1.0))
    return DetectorFault{"dark_doubling_k", "must be 0 or >= 1", d.dark_doubling_k};
  if (!(d.dark_doubling_k > 0.0) && d.temperature_c != d.dark_reference_c)
    return DetectorFault{"dark_doubling_k",
                         "must be > 0 when temperature_c is not dark_reference_c",
                         d.dark_doubling_k};
  if (!(std::fmax(d.dark_e_per_s, d.hot_pixel_e_per_s) * d.thermal_factor() <= max_e_per_s))
    return DetectorFault{"temperature_c", "dark current there must be <= 1e9 e-/s",
                         d.temperature_c};
  return std::nullopt;
}

DarkCurrent::Prepared DarkCurrent::prepare(const ExposureFacts& exposed) const {
  return ConstantPoisson(static_cast<float>(dark_e_per_s * exposed.exposure.exposure_s));
}

void DarkCurrent::apply(const ExposureFacts& exposed, const Prepared& deviates,
                        Piece& piece) const {
  deviates.add(exposed.key, std::uint32_t(piece.first), piece.electrons.data(),
               piece.electrons.size(), exposed.level);
}

}  // namespace dmise
