#include "core/config/sensors/unusual_cameras.h"

#include <array>
#include <cmath>

#include "core/base/formatted.h"
#include "core/base/units.h"
#include "core/config/yaml/yaml_reader.h"

namespace dmise {
namespace {

/// Usual range of a length of a telescope.
struct UsualLength {
  const char* key;
  double min_m, max_m;
};
// Pixels from 0.5 um (telephones) to 0.2 mm; focal lengths above 60 m occur only in
// interferometers; apertures up to 39 m (ELT).
constexpr std::array<UsualLength, 3> usual = {
    {{"pixel_pitch_m", 0.5e-6, 2e-4}, {"focal_length_m", 5e-4, 100.0}, {"aperture_m", 2e-4, 45.0}}};

struct Unit {
  const char* name;
  double m;
};
constexpr std::array<Unit, 2> units = {{{"millimetres", 1e-3}, {"micrometres", 1e-6}}};

std::string text_of(double x) { return formatted("%.4g", x); }

std::string unusual(double value_m, const UsualLength& length) {
  std::string text =
      "is unusual, " + text_of(length.min_m) + " to " + text_of(length.max_m) + " are usual";
  for (const Unit& unit : units)
    if (const double m = value_m * unit.m; m >= length.min_m && m <= length.max_m)
      return text + " (in " + unit.name + "? that is " + text_of(m) + ")";
  return text;
}

}  // namespace

std::vector<std::string> unusual_camera_values(const YamlValue& camera, const Camera& read) {
  std::vector<std::string> lines;
  YamlMap map(camera);
  const auto optics_value = map.require("optics"), detector_value = map.require("detector");
  YamlMap optics(optics_value), detector(detector_value);
  const auto warn = [&](YamlMap& of, const char* key, const std::string& text) {
    if (const auto at = of.find(key)) lines.push_back(at->complaint(text));
  };
  for (const auto& length : usual)
    if (const auto at = optics.find(length.key)) {
      const double value_m = at->number();
      if (value_m < length.min_m || value_m > length.max_m)
        lines.push_back(at->complaint(unusual(value_m, length)));
    }
  if (!lines.empty()) return lines;  // derived values add nothing
  const Optics& o = read.optics;
  constexpr double max_f_number = 100.0, widest_m = 1.0, finest_arcsec = 0.005, coarsest_deg = 3.0;
  if (o.f_number() > max_f_number)
    warn(optics, "aperture_m",
         "makes f/" + text_of(o.f_number()) + " with this focal length, which is unusual");
  if (o.columns * o.pixel_pitch_m > widest_m)
    warn(optics, "pixel_pitch_m",
         "makes a detector " + text_of(o.columns * o.pixel_pitch_m) + " m wide");
  if (o.pixel_angle_rad() < finest_arcsec * arcsec || o.pixel_angle_rad() > coarsest_deg * deg)
    warn(optics, "pixel_pitch_m",
         "makes pixels of " + text_of(o.pixel_angle_rad() / arcsec) + " arcsec, which is unusual");
  const Detector& d = read.detector;
  constexpr double well_ratio = 100.0, min_well_e = 100.0, max_well_e = 1e8;
  if (d.full_well_e < min_well_e || d.full_well_e > max_well_e)
    warn(detector, "full_well_e", "is unusual, 1000 to 1e7 are usual");
  const double range_e = d.gain_e_per_dn * std::exp2(d.adc_bits);
  if (range_e > well_ratio * d.full_well_e || range_e < d.full_well_e / well_ratio)
    warn(detector, "gain_e_per_dn",
         "makes all counts together " + text_of(range_e) + " e-, the full well is " +
             text_of(d.full_well_e));
  if (d.read_noise_e > 0.1 * d.full_well_e)
    warn(detector, "read_noise_e",
         "is more than a tenth of the full well of " + text_of(d.full_well_e));
  return lines;
}

}  // namespace dmise
