#pragma once
#include <optional>

#include "core/detection/curve/streak_light.h"
#include "core/products/light_curve.h"

namespace dmise {

/// What the light along a line says of its period, in pixels: when the object was where is not yet
/// known.
struct FoundPeriod {
  std::optional<LightPeriod> period;
  // The shortest that explains light that varies without showing its period.
  std::optional<double> min_period_px;
  // How far beyond either end the periodic light stays dark: so much of the line may be unseen.
  double dark_first_px = 0.0, dark_last_px = 0.0;
};

/// Largest probability of a false alarm of a period that is stated.
inline constexpr double max_false_alarm = 1e-3;

/// Compares periods of the light of a streak by their evidence: the probability of its pixels, over
/// that by even light with a slope, where harmonics of the period have any amplitudes of a normal
/// prior. The blur of the PSF is part of the model. A period is stated if it explains the light
/// better than noise, and than light that does not repeat, and if the line shows two flashes, two
/// dips or a whole sine. Its error is the width of the evidence as a function of the period.
/// Source: Bretthorst 1988, Bayesian Spectrum Analysis, chapter 6.
FoundPeriod light_period(const StreakLight& light);

}  // namespace dmise
