#pragma once
#include <functional>
#include <optional>

#include "core/base/pixel.h"
#include "core/optics/camera.h"
#include "core/sky/air/refraction.h"
#include "core/wcs/wcs.h"

namespace dmise {

/// The true mapping of an image: the ICRS direction (any length > 0) seen by a pixel, including
/// refraction and aberration, also below the horizon; empty where the camera images no direction.
using SkyOfPixel = std::function<std::optional<Vec<Gcrs>>(PixelPosition)>;

/// Atmosphere above a ground sensor, in camera coordinates.
struct CameraAir {
  Vec<CameraFrame> zenith;  // unit
  Refraction refraction;
};

/// Form of the WCS to fit.
struct WcsForm {
  Projection projection;                    // one that FITS has
  int order = 0;                            // 0..9 of the polynomials; below 2 there are none
  std::optional<WcsRefraction> refraction;  // in a camera of the same projection; offset ignored
  bool reference_is_refracted = true;       // omits the shift of the reference pixel
};

/// Fits a WCS of a given form to `sky` by least squares in pixels on a grid of Chebyshev points
/// (dense at the edges, so that the largest residual stays near the rms). `rms_px` and `max_px` of
/// the result compare it with `sky` on a finer grid; with refraction, only above the horizon and
/// including its lookup table. Throws `Error` if fewer pixels than unknowns see sky.
Wcs fit_wcs(const Optics& optics, const SkyOfPixel& sky, const WcsForm& form);

/// Fits the simplest WCS accurate to 0.08 px over the whole frame: TAN + SIP to a half diagonal of
/// 45 deg; the camera's own projection, if FITS has it, + SIP; otherwise, and if a horizon is in
/// the frame, that with separate refraction, whose lookup table is made for 0.06 px. `air` if `sky`
/// includes refraction.
Wcs best_wcs(const Optics& optics, const SkyOfPixel& sky, const std::optional<CameraAir>& air);

}  // namespace dmise
