#pragma once
#include <string>

#include "tests/pipeline/harness.h"
#include "tests/support/directions.h"

// Scenes for tests of what joins the models: what leaves the chain against other people's figures.
namespace dmise::test {

/// Counts are expected electrons, rounded: no sky, no noise, no limit.
inline const std::string noiseless =
    "sky: off, photon_noise: off, dark_current: off, read_noise: off, full_well: off, "
    "quantisation: off, scintillation: off";

/// A camera of square pixels of 10 um in a narrow band.
inline std::string camera(int columns, int rows, double focal_length_m,
                          const std::string& detector = "", const std::string& optics = "",
                          double centre_um = 0.55) {
  return "{optics: {columns: " + std::to_string(columns) + ", rows: " + std::to_string(rows) +
         ", pixel_pitch_m: 1.0e-5, focal_length_m: " + std::to_string(focal_length_m) +
         (optics.find("aperture_m") == std::string::npos ? ", aperture_m: 0.02" : "") + optics +
         "}, detector: {" +
         (detector.empty() ? "full_well_e: 1.0e+9, gain_e_per_dn: 1" : detector) +
         "}, band: {name: narrow, centre_m: " + std::to_string(centre_um) +
         "e-6, width_m: 1.0e-9}}";
}

inline const std::string with_stars = "stars: {catalogue: stars.csv, faintest_mag: 15}\n";

/// One sensor at a `place` ("site: {...}") with `more` keys; `world`: objects and stars.
inline std::string scenario(const std::string& start, double duration_s, const std::string& place,
                            const std::string& camera, const std::string& pointing,
                            double exposure_s, double cadence_s, const std::string& more = "",
                            const std::string& simulation = "", const std::string& world = "") {
  return "simulation: {start: " + start + ", duration_s: " + std::to_string(duration_s) +
         ", tick_s: 5" + simulation + "}\n" + world + "sensors:\n  - {name: a, " + place +
         ", camera: " + camera + ", pointing: " + pointing +
         ", exposure_s: " + std::to_string(exposure_s) +
         ", cadence_s: " + std::to_string(cadence_s) + more + "}\n";
}

/// The direction at an azimuth and elevation of a ground sensor, in mid exposure.
inline Vec<Gcrs> direction(const View& view, double azimuth_rad, double elevation_rad) {
  return view.enu_from_gcrs(view.times().middle).inverse() *
         from_horizontal({azimuth_rad, elevation_rad});
}

}  // namespace dmise::test
