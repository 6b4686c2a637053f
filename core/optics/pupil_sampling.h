#pragma once
#include <optional>
#include <vector>

#include "core/optics/psf_plan.h"
#include "core/optics/waves/pupil.h"

namespace dmise {

/// A wavelength and its fraction of the light; the fractions of a band sum to 1.
struct WavelengthShare {
  double wavelength_m = 0.0;
  double share = 1.0;
};

/// Whether exposures use drawn screens.
bool has_screens(const PsfPlan& plan);

/// A camera's pupil as seen from a position in the field.
Pupil pupil_at(const Optics& optics, const FieldPlace& place, double wavelength_m);

/// Steepest slope of a pupil's wavefront, including its centring tilt [rad of phase per aperture
/// radius].
double steepest_slope(const Pupil& pupil);

/// Steepest slope without the tilt, from the chief ray.
double steepest_slope_of(const std::vector<ZernikeTerm>& terms);

/// Grids of the pupil for each wavelength. Empty if the camera's kernel needs no pupil. Fine enough
/// that the wavefront changes by less than pi between samples anywhere in the field: otherwise
/// light would alias. Throws `ConfigError` "seeing.r0_m: reason" or "optics.KEY: reason" if that
/// takes more than `max_pupil_samples` across the aperture.
std::vector<PupilGrid> sample_pupils(const Optics& optics, const std::vector<WavelengthShare>& band,
                                     const PsfPlan& plan,
                                     const std::optional<SensorSeeing>& seeing);

/// Grid of the screens of turbulence, if `has_screens(plan)`: that of the plan's wavelength, so
/// that any number of wavelengths sees the same air. Throws as `sample_pupils` does.
PupilGrid sample_screens(const Optics& optics, const PsfPlan& plan,
                         const std::optional<SensorSeeing>& seeing);

inline constexpr int max_pupil_samples = 1024;

}  // namespace dmise
