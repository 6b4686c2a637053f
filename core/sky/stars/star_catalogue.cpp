#include "core/sky/stars/star_catalogue.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/units.h"
#include "core/frames/vec.h"

namespace dmise {

namespace {
constexpr double faintest_allowed_v_mag = 50.0;  // and brightest, below zero
}

StarTable table_of(StarCatalogue catalogue) {
  StarTable table{.epoch_jyear = catalogue.epoch_jyear};
  for_columns([](auto& to, auto& from) { to = std::move(from); }, table, catalogue);
  return table;
}

double faintest_filled_v_mag(std::span<const float> v_mags) {
  if (v_mags.empty()) return -std::numeric_limits<double>::infinity();
  constexpr int halves = 2 * int(faintest_allowed_v_mag);
  std::array<std::size_t, 2 * halves + 1> count = {};  // by half magnitude, from -50 on
  for (const float v_mag : v_mags) ++count[std::size_t(std::floor(2.0 * v_mag) + halves)];
  const auto fullest = std::max_element(count.begin(), count.end());
  return 0.5 * (int(fullest - count.begin()) - halves + 1);
}

std::optional<double> bv_of_spectral_type(std::string_view type) {
  static constexpr std::string_view classes = "OBAFGKM";
  // Subclasses 0 and 5 of each class, then M8 as the end of the scale.
  static constexpr std::array<double, 15> bv = {-0.33, -0.32, -0.30, -0.17, -0.02, 0.15, 0.30, 0.44,
                                                0.58,  0.68,  0.81,  1.15,  1.40,  1.64, 1.93};
  if (type.empty()) return std::nullopt;
  const std::size_t letter = classes.find(type[0]);
  if (letter == std::string_view::npos) return std::nullopt;
  const bool has_digit = type.size() > 1 && type[1] >= '0' && type[1] <= '9';
  const double at = 2.0 * double(letter) + (has_digit ? (type[1] - '0') / 5.0 : 1.0);
  const std::size_t low = std::size_t(at);
  return bv[low] + (at - double(low)) * (bv[low + 1] - bv[low]);
}

StarKind star_kind(const StarRecord& star, double bv) {
  constexpr double faintest_giant_mag = 4.5, min_dwarf_bv = 0.95;
  const std::string_view type = star.spectral_type;
  // Dwarfs are of class V; IV is that of subgiants.
  bool dwarf = false;
  for (std::size_t i = 1; i < type.size(); ++i) dwarf |= type[i] == 'V' && type[i - 1] != 'I';
  if (star.parallax_rad && *star.parallax_rad > 0.0)
    dwarf = star.v_mag + 5.0 + 5.0 * std::log10(*star.parallax_rad / arcsec) > faintest_giant_mag;
  if (type.size() > 1 && type[0] == 'M' && type[1] >= '0' && type[1] <= '9')
    return (dwarf ? m_dwarf : m_giant)(type[1] - '0');
  return dwarf && bv >= min_dwarf_bv ? StarKind::red_dwarf : StarKind::most;
}

const char* append_star(StarCatalogue& catalogue, const StarRecord& star) {
  if (!(star.ra_rad >= 0 && star.ra_rad < 2 * pi)) return "right ascension must be in [0, 360) deg";
  if (!(std::abs(star.dec_rad) <= pi / 2)) return "declination must be in [-90, 90] deg";
  if (!(std::abs(star.v_mag) <= faintest_allowed_v_mag)) return "magnitude must be in [-50, 50]";
  if (star.bv && !std::isfinite(*star.bv)) return "colour must be finite";
  const double pm_ra = star.pm_ra_cosdec_rad_per_yr.value_or(0.0);
  const double pm_dec = star.pm_dec_rad_per_yr.value_or(0.0);
  if (!(std::hypot(pm_ra, pm_dec) <= 100 * arcsec)) return "proper motion must be <= 100 arcsec/yr";
  if (star.parallax_rad && !(*star.parallax_rad <= 10 * arcsec))
    return "parallax must be <= 10 arcsec";

  std::uint8_t flags = 0;
  double bv = default_star_bv;
  if (star.bv) {
    bv = *star.bv;
  } else {
    flags |= star_has_no_colour;
    bv = bv_of_spectral_type(star.spectral_type).value_or(default_star_bv);
  }
  const bool has_parallax = star.parallax_rad && *star.parallax_rad > 0;
  if (!has_parallax) flags |= star_has_no_parallax;
  if (!star.pm_ra_cosdec_rad_per_yr || !star.pm_dec_rad_per_yr) flags |= star_has_no_proper_motion;
  flags |= std::uint8_t(int(star_kind(star, bv)) << star_kind_shift);

  catalogue.id.push_back(star.id);
  catalogue.ra_rad.push_back(star.ra_rad);
  catalogue.dec_rad.push_back(star.dec_rad);
  catalogue.pm_ra_cosdec_rad_per_yr.push_back(pm_ra);
  catalogue.pm_dec_rad_per_yr.push_back(pm_dec);
  catalogue.parallax_rad.push_back(has_parallax ? *star.parallax_rad : 0.0);
  catalogue.v_mag.push_back(float(star.v_mag));
  catalogue.bv.push_back(float(bv));
  catalogue.flags.push_back(flags);
  return nullptr;
}

void move_star(StarCatalogue& c, std::size_t i, double from_jyear, double to_jyear) {
  const Vec<Gcrs> p = from_spherical<Gcrs>(c.ra_rad[i], c.dec_rad[i]);
  const double sa = std::sin(c.ra_rad[i]), ca = std::cos(c.ra_rad[i]);
  const Vec<Gcrs> east{-sa, ca, 0.0};
  const Vec<Gcrs> north = cross(p, east);
  const Vec<Gcrs> rate = east * c.pm_ra_cosdec_rad_per_yr[i] + north * c.pm_dec_rad_per_yr[i];
  const Vec<Gcrs> moved = p + rate * (to_jyear - from_jyear);
  const auto [ra, dec] = to_spherical(moved);
  c.ra_rad[i] = ra;
  c.dec_rad[i] = dec;
  // Its space motion does not change, seen along the axes of the new place.
  const double distance = norm(moved);
  const Vec<Gcrs> east_now{-std::sin(ra), std::cos(ra), 0.0};
  const Vec<Gcrs> north_now = cross(moved / distance, east_now);
  c.pm_ra_cosdec_rad_per_yr[i] = dot(rate, east_now) / distance;
  c.pm_dec_rad_per_yr[i] = dot(rate, north_now) / distance;
}

}  // namespace dmise
