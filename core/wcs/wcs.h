#pragma once
#include <array>
#include <optional>
#include <vector>

#include "core/base/pixel.h"
#include "core/frames/vec.h"
#include "core/optics/camera.h"

// Evaluates the world coordinate system of an image: TAN, ARC, ZEA or STG (Calabretta & Greisen
// 2002, A&A 395, 1077) with SIP distortion (Shupe et al. 2005, ASP Conf. 347, 491), to which the
// air's is added. Works at the poles and across the wrap of right ascension: directions are vectors
// throughout. LONPOLE is 180 deg; a FITS header must say so, since its default at declination +90
// is 0.
namespace dmise {

/// What the air adds to a world coordinate system that polynomials can't hold, near the horizon:
/// a pixel's place is moved to where its star would be without air, as the camera images it.
/// Readers of FITS files find it as a lookup table.
struct WcsRefraction {
  Vec<CameraFrame> zenith;         // unit
  double focal_length_px = 0.0;    // of the lens
  std::optional<Projection> lens;  // where that is not the projection of the WCS
  double pressure_hpa = 0.0, temperature_c = 0.0, humidity = 0.0;  // at the camera
  double wavelength_um = 0.55;
  double offset_x_px = 0.0, offset_y_px = 0.0;  // the move of the reference pixel, left out of all
  double cell_px = 0.0;                         // step of the lookup table, both ways

  bool operator==(const WcsRefraction&) const = default;
};

/// World coordinate system of an image: a projection of FITS with SIP distortion (Shupe et al.
/// 2005) and, if a horizon is near, the air's own.
struct Wcs {
  Projection projection;                // one that FITS has
  double crpix_x = 0.0, crpix_y = 0.0;  // reference pixel, (0, 0) at the first pixel's centre
  double ra_rad = 0.0, dec_rad = 0.0;   // ICRS direction of the reference pixel
  std::array<double, 4> cd_deg{};       // CD1_1 CD1_2 CD2_1 CD2_2 [deg/px]
  int order = 0;                        // of the SIP polynomials, 0: none, at most 9
  // A_pq, B_pq (pixel -> intermediate) and AP_pq, BP_pq (back), index p * (order + 1) + q.
  std::vector<double> a, b, ap, bp;
  std::optional<WcsRefraction> refraction;
  // Against the true mapping where the sky is seen, as a reader of the FITS file finds it.
  double rms_px = 0.0, max_px = 0.0;

  bool operator==(const Wcs&) const = default;
};

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
