#pragma once
#include <optional>
#include <string>

namespace dmise {

/// What an archive asks of a frame beside what a detector must know: each is left out where it
/// makes no sense, and may be missing in files from elsewhere.
struct Observation {
  std::string object;                     // pointed at, by name; empty: none
  std::string telescope;                  // the camera's name; empty: none
  std::optional<double> start_mjd;        // UTC, start of the exposure
  std::optional<double> ra_rad, dec_rad;  // ICRS of the stars in the frame's centre, mid exposure
  std::optional<double> airmass;          // of the frame's centre; on the ground, above the horizon
  std::optional<double> sun_altitude_rad;   // of its centre over the site, without refraction
  std::optional<double> moon_altitude_rad;  // likewise

  bool operator==(const Observation&) const = default;
};

/// `text` as a FITS header can hold it: printable ASCII (others become ?), at most as many
/// characters as fit with their quotes doubled.
std::string header_text(const std::string& text);

}  // namespace dmise
