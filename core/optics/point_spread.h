#pragma once
#include <limits>
#include <vector>

#include "core/effects/accuracy.h"
#include "core/effects/effects.h"
#include "core/optics/field_blur.h"
#include "core/optics/focus_drift.h"
#include "core/optics/measured_psf.h"

namespace dmise {

/// Aberrations that grow with the distance from the boresight; rms path at the farthest corner.
struct FieldAberrations {
  double coma_m = 0.0;         // along the radius, grows linearly
  double astigmatism_m = 0.0;  // along the radius, grows quadratically
  double curvature_m = 0.0;    // defocus, grows quadratically

  bool any() const { return coma_m != 0.0 || astigmatism_m != 0.0 || curvature_m != 0.0; }
  bool operator==(const FieldAberrations&) const = default;
};

/// Point spread of a camera before pixel integration, and how it is computed.
struct PointSpread {
  static constexpr EffectFacts facts{
      "psf", "blur of the optics", "light falls on a point of no size",
      "Gaussian, Fourier optics of the pupil, or images from a file"};

  static ErrorBound error(int, const PlanFacts&) { return not_bounded; }
  /// The plane is transformed once, unless only the air makes it necessary, which is then charged;
  /// deposits are charged to their sources.
  static double cost_s(int level, const PlanFacts& f);

  enum class Model {
    gaussian,     // round, of `psf_fwhm_px` and diffraction in quadrature
    diffraction,  // by the pupil: wavefront, spiders, turbulence, jitter
    file,         // from images of a point source, with what air is in them
  };
  enum class Method {
    automatic,  // chosen by plan_psf
    deposit,    // the Gaussian integrated over pixels, source by source
    direct,     // the kernel summed source by source
    transform,  // one convolution of the whole frame on an oversampled grid
  };
  enum class Resampling {
    area,      // sum over the cells of each pixel: exact
    bilinear,  // between the cells around the pixel centre
  };

  Model model = Model::gaussian;
  Method method = Method::automatic;
  Resampling resampling = Resampling::area;
  int oversampling = 0;  // cells per pixel and axis, 1..16; 0: automatic
  int support_px = 0;    // radius of the kernel; 0: automatic
  int wavelengths = 1;   // over the band, 1..16
  int spiders = 0;       // vanes, 0..12
  double spider_width_m = 0.0;
  double defocus_m = 0.0;  // distance of the detector from the focus of infinity, away from it
  /// Range that is in focus, whose share of `defocus_m` is focal length^2 / range.
  double focus_distance_m = std::numeric_limits<double>::infinity();
  double jitter_rad = 0.0;  // rms of the pointing along one axis
  std::vector<WavefrontTerm> wavefront;
  FieldAberrations field;
  int grid_columns = 1, grid_rows = 1;  // kernels over the field, 1..9, interpolated
  int max_screens = 32;                 // beyond so many tau0: long exposure
  FieldBlur varying;                    // over the field, by tables
  FocusDrift drift;                     // moves the detector along the axis
  MeasuredPsfPointer measured;          // images for `file`, else null

  bool operator==(const PointSpread&) const = default;
};

}  // namespace dmise
