// Star catalogues of fixed columns.
#include "core/base/units.h"
#include "core/sky/stars/star_file.h"
#include "core/sky/stars/star_text.h"

namespace dmise {

using namespace star_text;

// Columns (from 1): 1-9 RA hhmmss.ss, 11-19 Dec sddmmss.s, 21-29 and 30-38 proper motion [mas/yr],
// in RA times cos Dec (61 Cygni A: 4155; without the factor it would be 5330), 39-45 parallax
// [mas], 47-51 V, 52-56 B-V, 57-58 spectral type. J2000.0. A value of zero stands for one that is
// not known: parallax, both motions, and B-V where the spectral type is not one of stars near 0 (O,
// B, A).
StarReading parse_kstars(std::string_view text, const std::string& name) {
  StarReading reading;
  std::uint32_t count = 0;
  for_lines(text, [&](std::string_view line, int at) {
    if (trimmed(line).empty() || line.front() == '#') return;
    StarRecord star{.id = ++count};
    const auto refuse = [&](const char* why) {
      reading.problems.push_back(at_line(name, at, why));
    };
    const auto ra_h = sexagesimal(columns(line, 1, 2), columns(line, 3, 4), columns(line, 5, 9));
    const auto dec =
        sexagesimal(columns(line, 12, 13), columns(line, 14, 15), columns(line, 16, 19));
    if (!ra_h || !dec || (line[10] != '+' && line[10] != '-'))
      return refuse("columns 1-19: no right ascension and declination (hhmmss.ss sddmmss.s)");
    star.ra_rad = *ra_h * 15 * deg;
    star.dec_rad = (line[10] == '-' ? -*dec : *dec) * deg;
    const auto pm_ra = parse_real(columns(line, 21, 29)),
               pm_dec = parse_real(columns(line, 30, 38));
    const auto parallax = parse_real(columns(line, 39, 45));
    const auto v = parse_real(columns(line, 47, 51)), bv = parse_real(columns(line, 52, 56));
    if (!pm_ra || !pm_dec || !parallax)
      return refuse("columns 21-45: no proper motion and parallax");
    if (!v || !bv || line.size() < 56) return refuse("columns 47-56: no magnitude and colour");
    if (*pm_ra != 0 || *pm_dec != 0) {
      star.pm_ra_cosdec_rad_per_yr = *pm_ra * mas;
      star.pm_dec_rad_per_yr = *pm_dec * mas;
    }
    if (*parallax > 0) star.parallax_rad = *parallax * mas;
    star.v_mag = *v;
    star.spectral_type = columns(line, 57, 58);
    const char letter = star.spectral_type.empty() ? ' ' : star.spectral_type[0];
    if (*bv != 0 || letter == 'O' || letter == 'B' || letter == 'A') star.bv = bv;
    if (const char* why = append_star(reading.catalogue, star)) refuse(why);
  });
  return reading;
}

// Columns as in the ReadMe of CDS V/50; epoch and equinox J2000.0, proper motion in RA times cos
// Dec. The fourteen entries without a place are novae and clusters that were taken out: passed
// over.
StarReading parse_bsc5(std::string_view text, const std::string& name) {
  StarReading reading;
  for_lines(text, [&](std::string_view line, int at) {
    if (trimmed(line).empty() || line.front() == '#') return;
    const auto refuse = [&](const char* why) {
      reading.problems.push_back(at_line(name, at, why));
    };
    const auto hr = parse_real(columns(line, 1, 4));
    if (!hr || *hr < 1 || *hr > 9999) return refuse("columns 1-4: no HR number");
    if (columns(line, 76, 90).empty()) return;
    StarRecord star{.id = std::uint32_t(*hr)};
    const auto ra_h =
        sexagesimal(columns(line, 76, 77), columns(line, 78, 79), columns(line, 80, 83));
    const auto dec =
        sexagesimal(columns(line, 85, 86), columns(line, 87, 88), columns(line, 89, 90));
    const std::string_view sign = columns(line, 84, 84);
    if (!ra_h || !dec || (sign != "+" && sign != "-"))
      return refuse("columns 76-90: no right ascension and declination");
    star.ra_rad = *ra_h * 15 * deg;
    star.dec_rad = (sign == "-" ? -*dec : *dec) * deg;
    const auto v = parse_real(columns(line, 103, 107));
    if (!v) return refuse("columns 103-107: no magnitude");
    star.v_mag = *v;
    star.bv = parse_real(columns(line, 110, 114));
    star.spectral_type = columns(line, 128, 147);
    const auto pm_ra = parse_real(columns(line, 149, 154)),
               pm_dec = parse_real(columns(line, 155, 160));
    if (pm_ra && pm_dec) {
      star.pm_ra_cosdec_rad_per_yr = *pm_ra * arcsec;
      star.pm_dec_rad_per_yr = *pm_dec * arcsec;
    }
    const auto parallax = parse_real(columns(line, 162, 166));
    if (parallax && *parallax > 0) star.parallax_rad = *parallax * arcsec;
    if (const char* why = append_star(reading.catalogue, star)) refuse(why);
  });
  return reading;
}

}  // namespace dmise
