#pragma once
#include <vector>

#include "core/detection/source/scene.h"
#include "core/detection/stars/star_agreement.h"

namespace dmise {

/// A catalogue's star as a frame shows it.
struct ShownStar {
  Trail trail;           // without flux
  double noise_e = 1.0;  // noise of a pixel there
  double flux_e = 0.0;
  double light_error = 0.0;  // relative, 1 sigma, of flux_e
  double most = 1.0;         // greatest light over flux_e, for a variable star that was not fitted
};

/// Returns the stars with the light that stars around them have on average. Those well above the
/// noise get their own place and light by least squares over their pixels, with the agreement's
/// scatters as prior and without the light of their neighbours. The prior of a variable star's
/// light is as wide as its range.
std::vector<ShownStar> shown_stars(const Scene& scene, const StarAgreement& agreement,
                                   const std::vector<ExpectedStar>& expected);

}  // namespace dmise
