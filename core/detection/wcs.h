#pragma once
#include <optional>

#include "core/base/pixel.h"
#include "core/detection/detection.h"
#include "core/frames/vec.h"

// Evaluates the world coordinate system of an image: TAN, ARC, ZEA or STG (Calabretta & Greisen
// 2002, A&A 395, 1077) with SIP distortion (Shupe et al. 2005, ASP Conf. 347, 491), to which the
// air's is added. Works at the poles and across the wrap of right ascension: directions are vectors
// throughout. LONPOLE is 180 deg; a FITS header must say so, since its default at declination +90
// is 0.
namespace dmise {

/// Direction of a pixel on the ICRS axes, a unit vector; where the projection images none, of the
/// nearest place that has one.
Vec<Gcrs> wcs_direction(const Wcs& wcs, PixelPosition pixel);

/// Pixel of a direction (any length > 0): AP, BP as the first guess, then Newton's method on the
/// forward polynomials down to 1e-9 px, so that it is the inverse of `wcs_direction` whatever AP
/// and BP leave. Nothing when the projection has no image of the direction (90 deg or more from the
/// reference for TAN), or so far outside the fitted image that the polynomials can't be inverted
/// there.
std::optional<PixelPosition> wcs_pixel(const Wcs& wcs, const Vec<Gcrs>& direction);

/// Whether the pixel may see sky: the projection images a direction there, and it is not more than
/// a pixel below a horizon that the `Wcs` knows.
bool wcs_sees_sky(const Wcs& wcs, PixelPosition pixel);

/// Where in units of SIP's focal plane [px from the reference pixel] a pixel lies.
PixelPosition wcs_focal_place(const Wcs& wcs, PixelPosition pixel);
/// Where there a direction (any length > 0) lies; nothing where the projection has no image.
std::optional<PixelPosition> wcs_focal_place(const Wcs& wcs, const Vec<Gcrs>& direction);

/// Angle of one pixel at the reference: the square root of the pixel's solid angle [rad/px].
double wcs_scale_rad_per_px(const Wcs& wcs);

}  // namespace dmise
