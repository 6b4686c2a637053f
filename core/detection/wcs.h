#pragma once
#include <optional>

#include "core/base/pixel.h"
#include "core/detection/detection.h"
#include "core/frames/vec.h"

// Evaluates the world coordinate system of an image: TAN (Calabretta & Greisen 2002, A&A 395, 1077)
// with SIP distortion (Shupe et al. 2005, ASP Conf. 347, 491). Works at the poles and across the
// wrap of right ascension: directions are vectors throughout. LONPOLE is 180 deg; a FITS header
// must say so, since its default at declination +90 is 0.
namespace dmise {

/// Direction of a pixel on the ICRS axes, a unit vector.
Vec<Gcrs> wcs_direction(const Wcs& wcs, PixelPosition pixel);

/// Pixel of a direction (any length > 0): AP, BP as the first guess, then Newton's method on the
/// forward polynomials down to 1e-9 px, so that it is the inverse of `wcs_direction` whatever AP
/// and BP leave. Nothing when the direction lies 90 deg or more from the reference, or so far
/// outside the fitted image that the polynomials can't be inverted there.
std::optional<PixelPosition> wcs_pixel(const Wcs& wcs, const Vec<Gcrs>& direction);

/// Angle of one pixel at the reference: the square root of the pixel's solid angle [rad/px].
double wcs_scale_rad_per_px(const Wcs& wcs);

}  // namespace dmise
