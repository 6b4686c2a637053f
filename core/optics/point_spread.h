#pragma once
#include <vector>

#include "core/effects/effects.h"

namespace dmise {

/// A Zernike term of the optics' wavefront, Noll's index; the rms in metres of path.
struct WavefrontTerm {
  int noll = 4;  // 4..66: piston and tilts move nothing but the image
  double rms_m = 0.0;

  bool operator==(const WavefrontTerm&) const = default;
};

/// Aberrations that grow with the distance from the boresight; rms of path at the farthest corner.
struct FieldAberrations {
  double coma_m = 0.0;         // along the radius, grows linearly
  double astigmatism_m = 0.0;  // along the radius, grows with its square
  double curvature_m = 0.0;    // defocus, grows with its square

  bool any() const { return coma_m != 0.0 || astigmatism_m != 0.0 || curvature_m != 0.0; }
  bool operator==(const FieldAberrations&) const = default;
};

/// How a camera blurs a point, before its pixels integrate the light.
struct PointSpread {
  static constexpr EffectFacts facts{"psf", "blur of the optics",
                                     "light falls on a point of no size",
                                     "Gaussian, or Fourier optics of the pupil"};

  enum class Model {
    gaussian,     // round, of `psf_fwhm_px` and diffraction in quadrature
    diffraction,  // of the pupil: wavefront, spiders, turbulence, jitter
  };
  enum class Method {
    automatic,  // see plan_psf
    deposit,    // the Gaussian integrated over pixels, source by source
    direct,     // the kernel summed source by source
    transform,  // one convolution of the whole frame on an oversampled grid
  };
  enum class Resampling {
    area,      // cells of the oversampled grid summed over each pixel: exact
    bilinear,  // between the cells around the pixel's centre
  };

  Model model = Model::gaussian;
  Method method = Method::automatic;
  Resampling resampling = Resampling::area;
  int oversampling = 0;  // cells a pixel along one axis, 1..16; 0: the least that samples the blur
  int support_px = 0;    // the kernel ends there; 0: automatic
  int wavelengths = 1;   // over the band, 1..16
  int spiders = 0;       // vanes, 0..12
  double spider_width_m = 0.0;
  double defocus_m = 0.0;   // of the detector from the focus, along the axis
  double jitter_rad = 0.0;  // of the pointing, rms along one axis
  std::vector<WavefrontTerm> wavefront;
  FieldAberrations field;
  int grid_columns = 1, grid_rows = 1;  // of kernels over the field, 1..9, linear between
  int most_screens = 32;                // longer exposures than so many tau0 are long ones

  bool operator==(const PointSpread&) const = default;
};

}  // namespace dmise
