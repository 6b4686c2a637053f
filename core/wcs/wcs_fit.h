#pragma once
#include <functional>
#include <optional>

#include "core/base/pixel.h"
#include "core/optics/camera.h"
#include "core/sky/refraction.h"
#include "core/wcs/wcs.h"

namespace dmise {

/// The true mapping of an image: the ICRS direction (any length > 0) seen by a pixel, with
/// everything that bends light on its way (refraction, aberration), also below the horizon; nothing
/// where the camera images no direction.
using SkyOfPixel = std::function<std::optional<Vec<Gcrs>>(PixelPosition)>;

/// The air of a ground sensor as its camera sees it.
struct CameraAir {
  Vec<CameraFrame> zenith;  // unit
  Refraction refraction;
};

/// What a fit is held to.
struct WcsForm {
  Projection projection;                    // one that FITS has
  int order = 0;                            // 0..9 of the polynomials; below 2 there are none
  std::optional<WcsRefraction> refraction;  // of a camera of the same projection; offset ignored
  bool reference_is_refracted = true;       // the move of the reference pixel is left out
};

/// Fits a WCS of a given form to `sky` by least squares in pixels on a grid of Chebyshev points
/// (dense at the edges, so that the largest residual stays near the rms). `rms_px` and `max_px` of
/// the result compare it with `sky` on a finer grid; with a refraction above the horizon alone, its
/// lookup table included. Throws `Error` when fewer pixels than unknowns see sky.
Wcs fit_wcs(const Optics& optics, const SkyOfPixel& sky, const WcsForm& form);

/// The simplest WCS that holds the whole frame to 0.08 px: TAN + SIP up to half diagonals of 45
/// deg; the camera's own projection, where FITS has it, + SIP; else, and where a horizon is in the
/// frame, that with the air's part by itself, whose lookup table is made for 0.06 px. `air` if
/// refraction is in `sky`.
Wcs best_wcs(const Optics& optics, const SkyOfPixel& sky, const std::optional<CameraAir>& air);

}  // namespace dmise
