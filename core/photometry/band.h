#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/photometry/curve.h"

namespace dmise {

/// A band in wavelength: a top hat, or a photon response curve if `response` has samples.
struct Band {
  std::string name = "V";
  double centre_m = 0.55e-6;
  double width_m = 0.128e-6;  // full width
  Curve response;             // transmission, quantum efficiency, [0, 1]; empty: the top hat

  double low_m() const {
    return response.empty() ? centre_m - width_m / 2 : response.wavelength_m.front();
  }
  double high_m() const {
    return response.empty() ? centre_m + width_m / 2 : response.wavelength_m.back();
  }
  bool operator==(const Band&) const = default;
};

/// Filters by name: "bessell-U" B V R I and "sdss-u" g r i z. Sources: Bessell 1990, PASP 102,
/// 1181; Doi et al. 2010, AJ 139, 1628 (with telescope, camera and 1.3 airmasses; scaled so that
/// the peak is 1).
std::optional<Band> filter_named(std::string_view name);
/// Returns the names that `filter_named` knows.
std::vector<std::string> filter_names();

/// Makes a band of a curve; centre and width are its mean wavelength and equivalent width. Throws
/// `Error` if the curve fails `check_curve`, exceeds 1 or has no width.
Band band_of(std::string name, Curve response);

/// Returns the band behind a further element (glass, detector, air): the product of the responses,
/// sampled every 2 nm or finer, so that its integral is correct to 1e-4. Outside its samples
/// `transmission` keeps its end values.
Band through(const Band& band, const Curve& transmission);

/// Wavelengths [m] between which the band is linear, ascending; at least two.
std::vector<double> knots(const Band& band);
/// Knots where `curve` is linear, too: with those of its samples that lie in the band.
std::vector<double> knots(const Band& band, const Curve& curve);

/// Throws `Error` "band NAME: reason" unless the band is finite, positive and transmits light.
void check_band(const Band& band);

}  // namespace dmise
