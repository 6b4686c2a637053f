#pragma once
#include <span>
#include <vector>

#include "core/photometry/band.h"
#include "core/photometry/star_spectrum.h"

namespace dmise {

/// Photons/s/m2 of stars in one band above the atmosphere: the spectrum of their colour
/// (`star_spectrum`), scaled to the star's V magnitude. Tabulated over B-V, within 1e-4 of the
/// integral.
class StarLight {
 public:
  /// `band`: the complete response, with telescope and atmosphere.
  explicit StarLight(const Band& band);

  double photons_per_s_m2(double v_mag, const StarColour& colour) const;
  /// The most of any colour.
  double max_photons_per_s_m2(double v_mag) const;

  /// The light of many stars of kind `most`, to 1e-14 of it; all spans must have one size.
  void photons_per_s_m2(std::span<const double> v_mag, std::span<const double> bv,
                        std::span<double> rate) const;

 private:
  double at_v_0(double bv) const;
  double at_v_0(const StarColour& colour) const;

  std::vector<double> at_v_0_;            // by B-V, `step` apart, from min_bv
  std::vector<double> red_dwarf_at_v_0_;  // red dwarfs from `min_dwarf_bv` on
  std::vector<double> m_at_v_0_;          // types M by kind from `m0_giant` on
};

}  // namespace dmise
