#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/sky/faint_starlight.h"
#include "sensors/forecast/detection_limit.h"
#include "sensors/objects/object_shapes.h"
#include "sensors/scene/frame_times.h"
#include "sensors/survey/noise_table.h"
#include "sensors/survey/survey_scene.h"

namespace dmise {

/// An object with light in one exposure, as it is expected without rendering.
struct ExpectedDetection {
  std::uint32_t object = 0;  // index in the population
  double signal_e = 0.0;     // its light in the frame
  double length_px = 0.0;    // its lit trail in the frame
  double star_px = 0.0;      // trail of a star there
  double unlike_px = 0.0;    // difference of both trails
  bool star_known = false;   // the catalogue would have a star of its light
  PixelPosition centroid;    // weighted by that light
  // Noise of a pixel there, without the object's own; in the darkest sky for what is too faint even
  // there.
  double noise_e = 0.0;
  double snr = 0.0;                                // after the ideal matched filter
  double probability = 0.0;                        // that it is detected
  double latitude_rad = 0.0, longitude_rad = 0.0;  // geocentric, under it in mid exposure

  ExpectedTrail trail() const { return {snr, length_px, star_px, unlike_px, star_known}; }
};

/// One exposure without rendering it.
struct ExposureForecast {
  std::vector<ExpectedDetection> looks;  // by ascending object
  std::uint32_t in_field = 0;            // objects in the frame and above the mask in mid exposure
  std::uint32_t sunlit = 0;              // those of them that see half of the Sun's disc or more
  bool closed = false;                   // the shutter: nothing is in the frame
};

/// What is expected in the exposures of one sensor: by the same states, directions, light, sky and
/// noise as its frames have (`ObjectSampler`, `SkyModel`, `expected_noise`), at three instants of
/// an exposure. Calls are const and may run concurrently.
class ExposureForecaster {
 public:
  /// Both must outlive it. Throws `ConfigError` for a platform or target that is not in the
  /// population.
  ExposureForecaster(const SurveyScene& scene, const SensorConfig& sensor);

  /// Looks at `objects`, ascending indices. Nothing if the platform or the target has no state.
  std::optional<ExposureForecast> of(const FrameTimes& commanded,
                                     std::span<const std::uint32_t> objects) const;

 private:
  const SurveyScene& scene_;
  const SensorConfig& sensor_;
  std::vector<std::uint32_t> needed_;  // platform and target, ascending
  ObjectShapes shapes_;
  NoiseTable noise_;
  BlurByRange blur_;
  DrawnStars drawn_;
  double complete_to_v_mag_;
  double mask_sine_ = -1.0;
};

}  // namespace dmise
