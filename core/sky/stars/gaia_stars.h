#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "core/sky/stars/star_catalogue.h"

namespace dmise {

/// A row of Gaia's table gaia_source with the units of its columns; NaN stands for a value that is
/// missing.
struct GaiaRow {
  static constexpr double missing = std::numeric_limits<double>::quiet_NaN();
  double ra_deg = missing, dec_deg = missing;
  double pmra_mas_per_yr = missing, pmdec_mas_per_yr = missing;  // the first times cos Dec
  double parallax_mas = missing;
  double ref_epoch_jyear = 2016.0;
  double g_mag = missing, bp_rp = missing;
};

/// A column of gaia_source, and where its value goes.
struct GaiaColumn {
  const char* name;
  double GaiaRow::*value;
};

/// The columns that are read; a table must have the first `needed_gaia_columns` of them.
inline constexpr std::array<GaiaColumn, 8> gaia_columns = {
    {{"ra", &GaiaRow::ra_deg},
     {"dec", &GaiaRow::dec_deg},
     {"phot_g_mean_mag", &GaiaRow::g_mag},
     {"bp_rp", &GaiaRow::bp_rp},
     {"pmra", &GaiaRow::pmra_mas_per_yr},
     {"pmdec", &GaiaRow::pmdec_mas_per_yr},
     {"parallax", &GaiaRow::parallax_mas},
     {"ref_epoch", &GaiaRow::ref_epoch_jyear}}};
inline constexpr std::size_t needed_gaia_columns = 3;

/// Johnson V and B-V of Gaia's G and BP - RP.
struct JohnsonLight {
  double v_mag = 0.0, bv = 0.0;
};

/// By Gaia's relations of BP - RP with G - V (-0.5 to 5.0) and, for B-V = 0.850 (BT - VT), with G -
/// VT and G - BT (-0.3 to 3.0; within 0.07 mag), held at the ends of their ranges. Source: Riello
/// et al. 2021, A&A 649, A3, appendix C; Gaia DR3 documentation, section 5.5.1.
JohnsonLight johnson_of_gaia(double g_mag, double bp_rp);

/// Appends the star of a row, moved to J2000.0. A star without a colour gets the V of one like the
/// Sun. Returns null, or what is wrong with the row, which is then left out.
const char* append_gaia_star(StarCatalogue& catalogue, std::uint32_t id, const GaiaRow& row);

}  // namespace dmise
