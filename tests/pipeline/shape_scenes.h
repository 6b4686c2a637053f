#pragma once
#include <cmath>
#include <numeric>
#include <string>

#include "core/base/units.h"
#include "core/photometry/magnitude.h"
#include "tests/pipeline/harness.h"

// Scenes of objects with a shape before a camera that stands in space.
namespace dmise::test {

inline const Vec<Gcrs> eye_m{4.2e7, 1e6, 2e6};

/// A direction, and two across it.
struct Sight {
  Vec<Gcrs> line, right, down;
};

/// An object `range_m` away, `right_m` and `down_m` aside, with further keys.
inline std::string shape_at(const std::string& name, const Sight& sight, double range_m,
                            double right_m, double down_m, const std::string& keys) {
  const Vec<Gcrs> r = eye_m + sight.line * range_m + sight.right * right_m + sight.down * down_m;
  char text[256];
  std::snprintf(text, sizeof text,
                "  - name: %s\n    motion: {fixed: {gcrs_m: [%.6f, %.6f, %.6f]}}\n", name.c_str(),
                r.x, r.y, r.z);
  return text + keys;
}

/// Attitude in which +z of the body looks at the camera.
inline std::string facing(const Sight& sight) {
  const Vec<Gcrs> z = -sight.line, x = sight.right, y = cross(z, x);
  const double trace = x.x + y.y + z.z;
  // Quaternion (scalar first) of the rotation whose columns are x, y, z.
  const double w = std::sqrt(std::max(0.0, 1 + trace)) / 2;
  double q[4] = {w, 0, 0, 0};
  if (w > 1e-3) {
    q[1] = (y.z - z.y) / (4 * w);
    q[2] = (z.x - x.z) / (4 * w);
    q[3] = (x.y - y.x) / (4 * w);
  } else {
    const double a = std::sqrt(std::max(0.0, 1 + x.x - y.y - z.z)) / 2;
    q[0] = (y.z - z.y) / (4 * a);
    q[1] = a;
    q[2] = (x.y + y.x) / (4 * a);
    q[3] = (x.z + z.x) / (4 * a);
  }
  char text[160];
  std::snprintf(text, sizeof text,
                "    attitude: {inertial: {gcrs_from_body: [%.12f, %.12f, %.12f, %.12f]}}\n", q[0],
                q[1], q[2], q[3]);
  return text;
}

struct ShapeScene {
  std::string objects;
  std::string pointing;
  std::string optics =
      "{columns: 128, rows: 128, pixel_pitch_m: 1.0e-5, focal_length_m: 1, aperture_m: 0.02}";
  std::string effects = "sky: off, ";
  std::string range_defocus = "off";  // cameras are focused on what is before them
  std::string more;                   // keys of the scenario
  int seed = 1;
  double gain_e_per_dn = 1.0;
  double exposure_s = 0.5;
};

inline std::string text_of(const ShapeScene& scene) {
  return "simulation: {start: 2018-01-21T00:15:00Z, duration_s: 10, tick_s: 5, seed: " +
         std::to_string(scene.seed) + "}\n" + scene.more +
         "objects:\n  - name: platform\n    motion: {fixed: {gcrs_m: [42000000, 1000000, "
         "2000000]}}\n" +
         scene.objects +
         "sensors:\n  - name: eye\n    platform: platform\n    pointing: " + scene.pointing +
         "\n    exposure_s: " + std::to_string(scene.exposure_s) +
         "\n    cadence_s: 5\n    sky: space\n    effects: {" + scene.effects +
         "range_defocus: " + scene.range_defocus +
         ", photon_noise: off, read_noise: off, dark_current: off, annual_aberration: off}\n    "
         "camera:\n      optics: " +
         scene.optics + "\n      detector: {full_well_e: 1.0e+9, gain_e_per_dn: " +
         std::to_string(scene.gain_e_per_dn) +
         ", adc_bits: 16}\n      band: {name: V, centre_m: 0.55e-6, width_m: 0.1e-6}\n";
}

/// One that is lit from behind the camera.
inline Sight lit_sight() {
  const Stage any(text_of({.objects = "", .pointing = "zenith"}));
  const Vec<Gcrs> line =
      unit(unit(any.states.environment({0}).sun_m) * -1.0 + Vec<Gcrs>{0.1, 0, 0});
  const Vec<Gcrs> right = unit(cross(line, Vec<Gcrs>{0, 0, 1}));
  return {line, right, cross(line, right)};
}

inline const Truth& truth_named(const FrameProducts& frame, const std::string& name) {
  for (const auto& truth : frame.truths)
    if (truth.name == name) return truth;
  throw std::runtime_error("no truth of " + name);
}

inline double total(const CountImage& counts) {
  return std::accumulate(counts.pixels.begin(), counts.pixels.end(), 0.0);
}

/// Electrons that the truth's magnitude stands for.
inline double magnitude_e(const FrameProducts& frame, const std::string& name) {
  const auto& truth = truth_named(frame, name);
  return frame.header.exposure_s *
         light_of_magnitude(truth.true_magnitude - frame.header.zero_point_mag) * truth.sunlit;
}

}  // namespace dmise::test
