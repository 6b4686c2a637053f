#pragma once
#include <optional>

#include "core/detection/curve/streak_light.h"
#include "core/products/light_curve.h"

namespace dmise {

/// A period of the light along a line.
struct FoundPeriod {
  LightPeriod period;  // in pixels: when the object was where is not yet known
  // How far beyond either end the periodic light stays dark: so much of the line may be unseen.
  double dark_first_px = 0.0, dark_last_px = 0.0;
};

/// Largest probability of a false alarm of a period that is stated.
inline constexpr double max_false_alarm = 1e-3;

/// Finds the period that explains the light of a streak better than even light that changes evenly
/// along it: a generalised periodogram of harmonics (Schwarzenberg-Czerny 1996, ApJ 460, L107; with
/// the constant and the slope fitted at each frequency as by Zechmeister & Kuerster 2009, A&A 496,
/// 577), by least squares over the pixels, so that the blur of the PSF is part of the model. The
/// number of harmonics and the period together have the best Bayesian information criterion. Empty
/// if noise has one as good with more than `max_false_alarm` (Baluev 2009, MNRAS 395, 1541), or if
/// fewer than two flashes or one whole sine are on the line, which show no period.
std::optional<FoundPeriod> light_period(const StreakLight& light);

}  // namespace dmise
