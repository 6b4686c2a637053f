#pragma once
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "core/optics/psf_plan.h"
#include "core/optics/pupil_sampling.h"
#include "core/optics/waves/frozen_flow.h"

namespace dmise {

/// Computes the kernels of a plan on the cells of its oversampled grid:
///  diffraction (obscuration, spiders, wavefront) x turbulence x jitter, or the images of a file,
/// over the wavelengths,
/// divided by the Gaussian of `grid_sigma_cells` of deposits on the grid, and not integrated over
/// cells, because deposits are. With bilinear resampling, multiplied by pixel / cell. A kernel
/// tapers off over the outer half of its radius. Aberrations of the pupil do not move the centroid:
/// that displacement is part of a camera's plate solution. Those of `psf_field` do: the kernel's
/// centre is the place of the chief ray.
class PsfModel {
 public:
  /// `turbulence` is the random key of this sensor's turbulence. Screens are sampled for the
  /// plan's wavelength, so that they are the same for any band. Throws as `sample_pupils` does.
  PsfModel(const Optics& optics, std::vector<WavelengthShare> band, const PsfPlan& plan,
           const std::optional<SensorSeeing>& seeing, const RngKey& turbulence);

  /// The model of a source that is out of focus: `optics` with its defocus, by `plan`, through the
  /// same air. A wavefront that is too steep for a pupil is taken as the disc of geometrical
  /// optics, through the air of a long exposure.
  PsfModel refocused(const Optics& optics, const PsfPlan& plan) const;

  /// Whether each exposure has its own kernels, for the air.
  bool changes() const { return flow_ != nullptr; }

  /// Sets the distance of the detector from the focus, the camera's and what it has drifted. It
  /// must be within that of the run.
  void set_defocus(double defocus_m);

  /// Kernel of an exposure that starts at `start_s` of simulation time and lasts `exposure_s`.
  PsfKernel kernel(const FieldPlace& place, double start_s, double exposure_s);

 private:
  bool is_round(const FieldPlace& place) const;
  double air_otf(double nu_per_rad, double wavelength_m) const;
  double extra_otf(double nu_x, double nu_y, double wavelength_m) const;
  const SampledOtf& extra_at(std::size_t wavelength);
  std::array<ZernikeTerm, 2> centring(const FieldPlace& place, std::size_t wavelength);
  PsfKernel round_kernel(double wavelength_m);
  double disc_otf(double nu_per_rad) const;
  PsfKernel file_kernel(const FieldPlace& place, double wavelength_m) const;
  PsfKernel gaussian_kernel(const FieldPlace& place, double wavelength_m);
  PsfKernel pupil_kernel_at(const FieldPlace& place, std::size_t wavelength,
                            const PhaseScreen* screen);

  Optics optics_;
  std::vector<WavelengthShare> band_;
  PsfPlan plan_;
  std::optional<SensorSeeing> seeing_;
  double cell_rad_;
  std::vector<PupilGrid> grids_;                  // one per wavelength
  std::vector<std::optional<SampledOtf>> extra_;  // one per wavelength; none: not yet asked for
  struct Centred {
    FieldPlace place;
    std::size_t wavelength;
    std::array<ZernikeTerm, 2> tilt;
  };
  std::vector<Centred> centred_;      // cache
  PupilGrid screen_grid_{};           // at the plan's wavelength
  std::shared_ptr<FrozenFlow> flow_;  // a function of time; shared by refocused models
};

}  // namespace dmise
