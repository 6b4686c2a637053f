#pragma once
#include <array>
#include <optional>
#include <vector>

#include "core/base/pixel.h"
#include "core/frames/vec.h"
#include "core/optics/camera.h"

// World coordinate systems: TAN, ARC, ZEA or STG (Calabretta & Greisen 2002, A&A 395, 1077) with
// SIP distortion (Shupe et al. 2005, ASP Conf. 347, 491) and optional refraction. Works at the
// poles and across the wrap of right ascension, because directions are vectors throughout. LONPOLE
// is 180 deg; a FITS header must state it, since its default at declination +90 is 0.
namespace dmise {

/// Refraction in a world coordinate system, which polynomials cannot represent near the horizon:
/// moves a pixel to where its star would be imaged without air. In FITS files it is a lookup table.
struct WcsRefraction {
  Vec<CameraFrame> zenith;         // unit
  double focal_length_px = 0.0;    // the lens's
  std::optional<Projection> lens;  // if it differs from the projection of the WCS
  double pressure_hpa = 0.0, temperature_c = 0.0, humidity = 0.0;  // at the camera
  double wavelength_um = 0.55;
  double offset_x_px = 0.0, offset_y_px = 0.0;  // shift of the reference pixel, subtracted
  double cell_px = 0.0;                         // step of the lookup table, both ways

  bool operator==(const WcsRefraction&) const = default;
};

/// World coordinate system of an image: a FITS projection with SIP distortion (Shupe et al. 2005)
/// and, if a horizon is near, refraction.
struct Wcs {
  Projection projection;                // one that FITS has
  double crpix_x = 0.0, crpix_y = 0.0;  // reference pixel, (0, 0) at the first pixel's centre
  double ra_rad = 0.0, dec_rad = 0.0;   // ICRS direction of the reference pixel
  std::array<double, 4> cd_deg{};       // CD1_1 CD1_2 CD2_1 CD2_2 [deg/px]
  int order = 0;                        // degree of the SIP polynomials, 0: none, at most 9
  // A_pq, B_pq (pixel -> intermediate) and AP_pq, BP_pq (back), index p * (order + 1) + q.
  std::vector<double> a, b, ap, bp;
  std::optional<WcsRefraction> refraction;
  // Error against the true mapping where sky is visible, as a reader of the FITS file finds it.
  double rms_px = 0.0, max_px = 0.0;

  bool operator==(const Wcs&) const = default;
};

/// Direction of a pixel on the ICRS axes, a unit vector; where the projection images none, that of
/// the nearest position with one.
Vec<Gcrs> wcs_direction(const Wcs& wcs, PixelPosition pixel);

/// Pixel of a direction (any length > 0): Newton's method on the forward polynomials down to 1e-9
/// px, starting from AP and BP, so that it is the inverse of `wcs_direction` whatever their
/// accuracy. Empty if the projection has no image of the direction (90 deg or more from the
/// reference for TAN), or so far outside the fitted image that the polynomials cannot be inverted.
std::optional<PixelPosition> wcs_pixel(const Wcs& wcs, const Vec<Gcrs>& direction);

/// Whether a pixel may see sky: the projection images a direction there, and it is at most a pixel
/// below the horizon, if the `Wcs` has one.
bool wcs_sees_sky(const Wcs& wcs, PixelPosition pixel);

/// Position of a pixel in SIP's focal plane [px from the reference pixel].
PixelPosition wcs_focal_place(const Wcs& wcs, PixelPosition pixel);
/// Position there of a direction (any length > 0); empty where the projection has no image.
std::optional<PixelPosition> wcs_focal_place(const Wcs& wcs, const Vec<Gcrs>& direction);

/// Angle of one pixel at the reference: the square root of the pixel's solid angle [rad/px].
double wcs_scale_rad_per_px(const Wcs& wcs);

}  // namespace dmise
