#include "core/sky/stars/gaia_stars.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"

namespace dmise {

JohnsonLight johnson_of_gaia(double g_mag, double bp_rp) {
  const double x = std::clamp(bp_rp, -0.5, 5.0);
  const double g_v = -0.02704 + x * (0.01424 + x * (-0.2156 + x * 0.01426));
  const double y = std::clamp(bp_rp, -0.3, 3.0);
  const double g_vt = -0.01077 + y * (-0.0682 + y * (-0.2387 + y * 0.02342));
  const double g_bt =
      -0.004288 + y * (-0.8547 + y * (0.1244 + y * (-0.9085 + y * (0.4843 + y * -0.06814))));
  return {.v_mag = g_mag - g_v, .bv = 0.850 * (g_vt - g_bt)};
}

const char* append_gaia_star(StarCatalogue& catalogue, std::uint32_t id, const GaiaRow& row) {
  if (!std::isfinite(row.g_mag)) return "phot_g_mean_mag: must be a number";
  if (!(row.ref_epoch_jyear > 1500 && row.ref_epoch_jyear < 2500))
    return "ref_epoch: must be in (1500, 2500)";
  constexpr double sunlike_bp_rp = 0.82;  // as `default_star_bv`
  const bool has_colour = std::isfinite(row.bp_rp);
  const JohnsonLight light = johnson_of_gaia(row.g_mag, has_colour ? row.bp_rp : sunlike_bp_rp);
  StarRecord star{
      .id = id, .ra_rad = row.ra_deg * deg, .dec_rad = row.dec_deg * deg, .v_mag = light.v_mag};
  if (has_colour) star.bv = light.bv;
  if (!std::isnan(row.pmra_mas_per_yr) && !std::isnan(row.pmdec_mas_per_yr)) {
    star.pm_ra_cosdec_rad_per_yr = row.pmra_mas_per_yr * mas;
    star.pm_dec_rad_per_yr = row.pmdec_mas_per_yr * mas;
  }
  if (!std::isnan(row.parallax_mas) && row.parallax_mas > 0)
    star.parallax_rad = row.parallax_mas * mas;
  if (const char* why = append_star(catalogue, star)) return why;
  if (star.pm_ra_cosdec_rad_per_yr)
    move_star(catalogue, catalogue.size() - 1, row.ref_epoch_jyear, catalogue.epoch_jyear);
  return nullptr;
}

}  // namespace dmise
