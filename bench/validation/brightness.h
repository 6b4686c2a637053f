#pragma once
#include <string>
#include <vector>

#include "bench/validation/curve_power.h"
#include "bench/validation/observed_light.h"
#include "core/config/objects/object_model_config.h"
#include "core/facets/facet_light.h"
#include "core/facets/glints.h"

namespace dmise {

/// A light curve's point beside what the family's model gives.
struct ComparedLight {
  std::size_t track = 0;
  double time_s = 0.0;
  double measured_mag = 0.0, predicted_mag = 0.0;
  double smooth_mag = 0.0;  // predicted without glints
  double range_m = 0.0, phase_rad = 0.0;
  bool held_out = false;        // from the fit of the model
  Vec<Body> to_sun, to_viewer;  // unit
  double difference_mag() const { return measured_mag - predicted_mag; }  // > 0: model too bright
};

/// How a family's measurements are halved, never within a track: those up to the track of the
/// middle one are fitted, or every other track.
enum class Halves { by_time, by_track };

/// What is measured of one half.
struct BrightnessFigures {
  std::size_t lights = 0, tracks = 0;
  double median_mag = 0.0, mean_mag = 0.0;  // differences of all lights
  double scatter_mag = 0.0;                 // their standard deviation
  double phase_law_scatter_mag = 0.0;       // left by a phase law that is fitted to the fitted half
  double track_scatter_mag = 0.0;           // standard deviation of the tracks' median differences
  // Median over tracks of the standard deviation within them of means over a second.
  double within_measured_mag = 0.0, within_predicted_mag = 0.0, within_difference_mag = 0.0;
};

struct FamilyBrightness {
  std::string model, what, source;
  std::string split;  // in words
  std::size_t left_out = 0;
  double worst_rms_m = 0.0;  // greatest rms in a pass: stated ranges about its orbit
  std::vector<ComparedLight> lights;
  BrightnessFigures fitted, held_out;
  CurvePower fitted_power, held_out_power;                   // power in light curves
  double target_median_mag = 0.0, target_scatter_mag = 0.0;  // 0: 1.2 times the phase law's
};

/// The light of a model in a band for a Sun, an observer and an attitude.
class ModelLight {
 public:
  explicit ModelLight(const ObjectModel& model);
  /// V (Vega) without glints, with `to_sun` and `to_viewer` of the body if they are wanted.
  double v_mag(const ObservedLight& light, Vec<Body>* to_sun = nullptr,
               Vec<Body>* to_viewer = nullptr) const;
  /// What the small parts of an object add to it.
  double glints_mag(std::uint64_t seed, std::uint32_t object, const Vec<Body>& to_sun,
                    const Vec<Body>& to_viewer) const;

 private:
  const ObjectModel& model_;
  FacetLight facets_;
  std::optional<GlintField> glints_;
};

/// Compares every `every`th measurement in `directory` with the shipped models, and all of light
/// curves for their power. Throws
/// `ConfigError` for a file that is not there, cannot be read or leaves nothing to judge.
std::vector<FamilyBrightness> compare_brightness(const std::string& directory, std::size_t every);

/// The points as CSV, for a fit of surfaces.
std::string brightness_csv(const std::vector<FamilyBrightness>& families);

}  // namespace dmise
