#include "bench/cropped_camera.h"

#include <cmath>
#include <map>
#include <sstream>

#include "core/base/error.h"
#include "core/base/files/text_file.h"
#include "core/base/units.h"
#include "core/config/yaml/search_path.h"

namespace dmise {
namespace {

std::string number(double value) {
  std::ostringstream text;
  text.precision(12);
  text << value;
  return text.str();
}

/// The keys of a preset's section, whose lines are indented.
using KeyValues = std::map<std::string, std::string>;

std::map<std::string, KeyValues> sections_of(const std::string& yaml) {
  std::map<std::string, KeyValues> sections;
  std::istringstream lines(yaml);
  std::string line, section;
  while (std::getline(lines, line)) {
    const auto colon = line.find(": ");
    if (!line.empty() && line[0] != ' ') section = line.substr(0, line.find(':'));
    if (section == "band" && colon != std::string::npos)
      sections["band"]["flow"] = line.substr(colon + 2);
    else if (line.starts_with("  ") && colon != std::string::npos)
      sections[section][line.substr(2, colon - 2)] = line.substr(colon + 2);
  }
  return sections;
}

std::string flow(const KeyValues& section) {
  std::string text;
  for (const auto& [key, value] : section) text += (text.empty() ? "" : ", ") + key + ": " + value;
  return "{" + text + "}";
}

/// Gives a preset of a Gaussian point the diffraction of its pupil; one whose pixels are too wide
/// for it also the jitter of its mount.
void take_pupil(KeyValues& optics, bool wide_pixels, SceneDice& dice) {
  optics.erase("psf_fwhm_px");
  optics["psf"] = "diffraction";
  if (wide_pixels) optics["jitter_px"] = number(dice.uniform(0.3, 0.8));
}

}  // namespace

CroppedCamera cropped_camera(const std::string& name, int side_px, SceneDice& dice) {
  const std::string path = find_preset("cameras", name, "");
  if (path.empty()) throw Error("there is no camera " + name);
  auto sections = sections_of(read_text_file(path, 1u << 20));
  KeyValues& optics = sections["optics"];
  KeyValues& detector = sections["detector"];
  const auto value = [](const KeyValues& s, const char* key, double otherwise) {
    const auto found = s.find(key);
    return found == s.end() ? otherwise : std::stod(found->second);
  };
  const double pitch_m = value(optics, "pixel_pitch_m", 1e-5);
  double focal_m = value(optics, "focal_length_m", 0.0);
  if (const double field_deg = value(optics, "field_of_view_deg", 0.0); field_deg > 0.0) {
    focal_m = value(optics, "columns", 1.0) * pitch_m / 2.0 / std::tan(field_deg / 2.0 * deg);
    optics.erase("field_of_view_deg");
    optics["focal_length_m"] = number(focal_m);
  }
  optics["columns"] = optics["rows"] = std::to_string(side_px);
  const bool with_pupil = (name == "raven" || name == "gt-sort") && dice.chance(0.5);
  if (with_pupil) take_pupil(optics, name == "raven", dice);
  CroppedCamera camera{.name = name, .diffraction = optics.contains("psf")};
  const double aperture_m = value(optics, "aperture_m", 0.1);
  camera.pixel_rad = pitch_m / focal_m;
  camera.fwhm_px = camera.diffraction ? 1.0 + 0.6e-6 / aperture_m / camera.pixel_rad
                                      : value(optics, "psf_fwhm_px", 1.5);
  camera.read_noise_e = value(detector, "read_noise_e", 0.0);
  camera.dark_e_per_s = value(detector, "dark_e_per_s", 0.0);
  const std::string& band = sections["band"]["flow"];
  const double width_um = std::stod(band.substr(band.find("width_m: ") + 9)) * 1e6;
  const double open = 1.0 - std::pow(value(optics, "obscuration", 0.0), 2.0);
  constexpr double zero_photons_per_s_m2_um = 1e11;
  camera.zero_e_per_s = zero_photons_per_s_m2_um * width_um * pi / 4.0 * aperture_m * aperture_m *
                        open * value(optics, "transmission", 1.0) *
                        value(detector, "quantum_efficiency", 1.0);
  if (dice.chance(0.25))
    optics["vignetting"] = "{natural: true, corner: " + number(dice.uniform(0.5, 1.0)) + "}";
  if (dice.chance(0.15)) {
    optics["ghost_fraction"] = number(dice.log_uniform(1e-5, 1e-3));
    optics["ghost_radius_px"] = number(dice.uniform(2.0, 20.0));
  }
  // With many pixels a point more screens only take longer.
  if (camera.diffraction && !with_pupil) optics["most_screens"] = "2";
  if (camera.diffraction && dice.chance(0.5))
    optics["wavelengths"] = std::to_string(2 + dice.below(7));
  if (name.starts_with("hawaii") && dice.chance(0.15)) {
    optics["psf_grid"] = "{columns: 3, rows: 3}";
    optics["field_nm"] = "{coma: " + number(dice.uniform(5.0, 80.0)) + "}";
  }
  if (dice.chance(0.2)) detector["prnu_rms"] = number(dice.log_uniform(1e-3, 3e-2));
  if (dice.chance(0.1)) detector["nonlinearity"] = number(dice.log_uniform(1e-3, 0.05));
  camera.yaml = "{name: " + name + ", optics: " + flow(optics) + ", detector: " + flow(detector) +
                ", band: " + band + "}";
  return camera;
}

}  // namespace dmise
