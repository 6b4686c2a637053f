#include "core/optics/camera.h"

#include <cmath>

#include "core/base/error.h"
#include "core/base/formatted.h"
#include "core/base/units.h"

namespace dmise {
namespace {

void require(bool holds, const char* key, const char* reason, double got) {
  if (!holds)
    throw ConfigError(std::string("optics.") + key + ": " + reason + ", got " + shortest_text(got));
}

}  // namespace

double Optics::collecting_area_m2() const {
  return pi / 4 * aperture_m * aperture_m * (1.0 - obscuration * obscuration);
}

void check(const Optics& o) {
  const auto positive = [](double v) { return v > 0.0 && std::isfinite(v); };
  require(positive(o.focal_length_m), "focal_length_m", "must be > 0", o.focal_length_m);
  require(positive(o.aperture_m), "aperture_m", "must be > 0", o.aperture_m);
  require(positive(o.pixel_pitch_m), "pixel_pitch_m", "must be > 0", o.pixel_pitch_m);
  require(o.obscuration >= 0.0 && o.obscuration < 1.0, "obscuration", "must be in [0, 1)",
          o.obscuration);
  require(o.columns >= 1 && o.columns <= 65536, "columns", "must be 1..65536", o.columns);
  require(o.rows >= 1 && o.rows <= 65536, "rows", "must be 1..65536", o.rows);
  require(o.transmission > 0.0 && o.transmission <= 1.0, "transmission", "must be in (0, 1]",
          o.transmission);
  require(o.psf_fwhm_px >= 0.0 && o.psf_fwhm_px <= 1000.0, "psf_fwhm_px", "must be in 0..1000",
          o.psf_fwhm_px);
  require(o.equivalent_aperture || o.f_number() >= 0.5, "aperture_m",
          "focal ratio below 0.5 needs equivalent_aperture: true", o.aperture_m);
}

}  // namespace dmise
