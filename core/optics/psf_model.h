#pragma once
#include <array>
#include <optional>
#include <vector>

#include "core/optics/frozen_flow.h"
#include "core/optics/psf_plan.h"
#include "core/optics/pupil_sampling.h"

namespace dmise {

/// Makes the kernels that a plan asks for, on the cells of its oversampled grid:
///   diffraction (obscuration, spiders, wavefront) x turbulence x jitter, over the wavelengths,
/// divided by the Gaussian of `grid_sigma_cells` that deposits on the grid have, and not integrated
/// over cells, which deposits are. With bilinear resampling times pixel / cell. A kernel fades out
/// over the outer half of its radius. The pupil's own aberrations leave the light's centroid where
/// a point is: what they displace is part of a camera's plate solution.
class PsfModel {
 public:
  /// `turbulence` names the random numbers of this sensor's air. The first wavelength share is the
  /// one screens are sampled for. Throws as `sample_pupils` does.
  PsfModel(const Optics& optics, std::vector<WavelengthShare> band, const PsfPlan& plan,
           const std::optional<SensorSeeing>& seeing, const RngKey& turbulence);

  /// True when each exposure has kernels of its own.
  bool changes() const { return flow_.has_value(); }

  /// Kernel of an exposure that starts at `start_s` of simulation time and lasts `exposure_s`.
  PsfKernel kernel(const FieldPlace& place, double start_s, double exposure_s);

  /// Share of the light beyond the kernel's end, given back by scaling; of the last symmetric
  /// kernel made.
  double lost() const { return lost_; }

 private:
  bool is_round(const FieldPlace& place) const;
  double air_otf(double nu_per_rad, double wavelength_m) const;
  double extra_otf(double nu_x, double nu_y, double wavelength_m) const;
  std::array<ZernikeTerm, 2> centring(const FieldPlace& place, std::size_t wavelength) const;
  PsfKernel round_kernel(double wavelength_m);
  PsfKernel pupil_kernel_at(const FieldPlace& place, std::size_t wavelength,
                            const PhaseScreen* screen);

  Optics optics_;
  std::vector<WavelengthShare> band_;
  PsfPlan plan_;
  std::optional<SensorSeeing> seeing_;
  double cell_rad_;
  std::vector<PupilGrid> grids_;  // one a wavelength
  struct Centred {
    FieldPlace place;
    std::size_t wavelength;
    std::array<ZernikeTerm, 2> tilt;
  };
  std::vector<Centred> centred_;  // of the places asked for
  std::optional<FrozenFlow> flow_;
  double lost_ = 0.0;
};

}  // namespace dmise
