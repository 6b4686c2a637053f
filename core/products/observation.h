#pragma once
#include <optional>
#include <string>

namespace dmise {

/// Metadata for archives that detection does not need: each is omitted where it is meaningless, and
/// may be missing in foreign files.
struct Observation {
  std::string object;                     // name of the target; empty: none
  std::string telescope;                  // the camera's name; empty: none
  std::optional<double> start_mjd;        // UTC, start of the exposure
  std::optional<double> ra_rad, dec_rad;  // ICRS of the stars in the frame's centre, mid exposure
  std::optional<double> airmass;          // in the frame's centre; on the ground, above the horizon
  std::optional<double> sun_altitude_rad;   // its centre over the site, without refraction
  std::optional<double> moon_altitude_rad;  // as that of the Sun

  bool operator==(const Observation&) const = default;
};

/// Converts `text` for a FITS header: printable ASCII (others become ?), truncated to fit with its
/// quotes doubled.
std::string header_text(const std::string& text);

}  // namespace dmise
