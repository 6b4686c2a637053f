#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/photometry/band.h"

namespace dmise {

/// Extinction [mag/airmass] over wavelength of a real site: "lick" (the default: k_V 0.18, 1290 m),
/// "ctio", "kitt_peak", "la_palma", "mauna_kea", "paranal". Sources are in extinction_tables.inc.
std::optional<Curve> extinction_of_site(std::string_view site);
std::vector<std::string> extinction_site_names();
/// That of "lick" scaled so that it is `k_v` [mag/airmass] at 550 nm; for a hazier or clearer
/// place.
Curve extinction_scaled_to(double k_v);

/// Transmission of the air from above it to an airmass: 10^(-0.4 k X) every 5 nm.
Curve air_transmission(const Curve& extinction_mag_per_airmass, double airmass);

/// Extinction of sunlight in a band at the zenith [mag]; the band within 0.2-5 um.
double zenith_extinction_mag(const Band& band, const Curve& extinction_mag_per_airmass);

/// Beer's law for a whole band: the share of a source's photons in the band that arrives. It
/// depends on the source's colour, and not quite exponentially on airmass: tables of both, within
/// 0.1 % of the integral.
class BandExtinction {
 public:
  /// `extinction` [mag/airmass]; the end values hold outside.
  BandExtinction(const Band& band, const Curve& extinction_mag_per_airmass);

  /// For a star of this B-V (`star_spectrum`); airmass in [0, 40], beyond it is clamped.
  double of_star(double airmass, double bv) const;
  /// Factors of many stars, to 1e-15 of it.
  void of_stars(std::span<const double> airmass, std::span<const double> bv,
                std::span<double> share) const;
  /// For sunlit objects: as for a star of the Sun's colour.
  double of_sunlight(double airmass) const;

 private:
  double log_of_star(double airmass, double bv) const;

  std::vector<double> log_of_transmission_;  // colours x airmasses
};

}  // namespace dmise
