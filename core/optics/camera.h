#pragma once
#include <string>

#include "core/optics/image_optics.h"
#include "core/optics/point_spread.h"
#include "core/optics/stray_light.h"
#include "core/optics/thermal_optics.h"
#include "core/optics/vignetting.h"
#include "core/projection/projection.h"

namespace dmise {

/// The optics of a camera and the geometry of its pixels. `transmission` includes the filter.
struct Optics {
  Projection projection;
  double focal_length_m = 0.0;
  double aperture_m = 0.0;   // entrance pupil diameter
  double obscuration = 0.0;  // secondary / primary diameter, [0, 1)
  double pixel_pitch_m = 0.0;
  int columns = 0;
  int rows = 0;
  double transmission = 1.0;  // (0, 1]
  double psf_fwhm_px = 1.5;   // blur by lens and focus (Gaussian), before pixel integration; >= 0
  PointSpread spread;         // how points are blurred, and by which method
  Vignetting vignetting;
  StrayLight stray_light;            // light from beside the field
  ThermalOptics thermal;             // heat of telescope and window
  ImageOptics image;                 // effects on the whole image
  bool equivalent_aperture = false;  // allows N < 0.5: aperture is only a collecting area

  /// Area of the entrance pupil without the obscuration [m2].
  double collecting_area_m2() const;
  double pixel_angle_rad() const { return pixel_pitch_m / focal_length_m; }  // at the centre
  double focal_length_px() const { return focal_length_m / pixel_pitch_m; }
  double f_number() const { return focal_length_m / aperture_m; }
};

/// Throws `ConfigError` "optics.KEY: reason, got value" for impossible parameters. A focal ratio
/// below 0.5 violates conservation of radiance and is refused unless `equivalent_aperture`.
void check(const Optics& optics);

}  // namespace dmise
