#pragma once
#include <optional>
#include <vector>

#include "core/optics/psf_plan.h"
#include "core/optics/pupil.h"

namespace dmise {

/// A wavelength and its share of the light; the shares of a band sum to 1.
struct WavelengthShare {
  double wavelength_m = 0.0;
  double share = 1.0;
};

/// A place in the field: distance and angle (from +x to +y) from the principal point, 1 at the
/// frame's farthest corner.
struct FieldPlace {
  double radius = 0.0;
  double angle_rad = 0.0;

  bool operator==(const FieldPlace&) const = default;
};

/// True when exposures are seen through drawn screens.
bool has_screens(const PsfPlan& plan);

/// A camera's pupil as a place in its field sees it.
Pupil pupil_at(const Optics& optics, const FieldPlace& place, double wavelength_m);

/// The steepest slope of a pupil's wavefront, its centring tilt included [rad of phase over the
/// aperture's radius].
double steepest_slope(const Pupil& pupil);

/// Grids of the pupil for each wavelength, the first the one screens are sampled for; none where
/// the camera's kernel needs no pupil. So fine that the wavefront turns by less than pi between
/// samples anywhere in the field: otherwise light would come out of the transform where none falls.
/// Throws `ConfigError` "seeing.r0_m: reason" or "optics.KEY: reason" where that takes more than
/// `most_pupil_samples` across the aperture.
std::vector<PupilGrid> sample_pupils(const Optics& optics, const std::vector<WavelengthShare>& band,
                                     const PsfPlan& plan,
                                     const std::optional<SensorSeeing>& seeing);

inline constexpr int most_pupil_samples = 1024;

}  // namespace dmise
