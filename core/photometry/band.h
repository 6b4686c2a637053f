#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/photometry/curve.h"

namespace dmise {

/// A band in wavelength: a top hat, or a curve of response to photons where `response` has samples.
struct Band {
  std::string name = "V";
  double centre_m = 0.55e-6;
  double width_m = 0.128e-6;  // full width
  Curve response;             // of transmission, quantum efficiency, [0, 1]; empty: the top hat

  double low_m() const {
    return response.empty() ? centre_m - width_m / 2 : response.wavelength_m.front();
  }
  double high_m() const {
    return response.empty() ? centre_m + width_m / 2 : response.wavelength_m.back();
  }
  bool operator==(const Band&) const = default;
};

/// Filters by name: "bessell-U" B V R I and "sdss-u" g r i z. Sources: Bessell 1990, PASP 102,
/// 1181; Doi et al. 2010, AJ 139, 1628 (with telescope, camera and 1.3 airmasses; scaled to a peak
/// of 1).
std::optional<Band> filter_named(std::string_view name);
/// Their names.
std::vector<std::string> filter_names();

/// A band from a curve; centre and width become its mean wavelength and equivalent width. Throws
/// `Error` when the curve is not one of a response: see `check_curve`, values above 1, no width.
Band band_of(std::string name, Curve response);

/// The band behind another piece of glass, detector or air: the product of the responses, sampled
/// every 2 nm or finer, so that its integral is right to 1e-4. Outside its samples `transmission`
/// is its end value.
Band through(const Band& band, const Curve& transmission);

/// Wavelengths [m] between which the band is linear; at least two.
std::vector<double> knots(const Band& band);

/// Throws `Error` "band NAME: reason" unless the band is one light can pass.
void check_band(const Band& band);

}  // namespace dmise
