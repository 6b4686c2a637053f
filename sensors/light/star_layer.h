#pragma once
#include <memory>
#include <span>
#include <vector>

#include "core/base/image.h"
#include "core/base/parallel.h"
#include "core/photometry/star_light.h"
#include "core/sky/stars/star_cache.h"
#include "sensors/scene/occlusion_mask.h"
#include "sensors/scene/optics_stage.h"
#include "sensors/sky/field_stars.h"

namespace dmise {

struct StarExposure;
struct StarTrail;

/// In the numbers of planets, with their place among `all_planets`.
inline constexpr std::uint64_t planet_bit = std::uint64_t(1) << 62;

/// One star or planet as it was drawn.
struct StarTruth {
  // In its catalogue; of a synthetic star with `synthetic_star_bit`, of a planet with `planet_bit`.
  std::uint64_t id = 0;
  double v_mag = 0.0, bv = 0.0;
  double x_px = 0.0, y_px = 0.0;     // centroid of its light in the frame
  double signal_e = 0.0;             // expected electrons deposited in the frame
  PixelPosition start, middle, end;  // places on its trail, also beside the frame
};

/// The star background: every star of the field with its own place and its own trail, and the
/// synthetic ones that go on where the catalogue ends.
class StarLayer {
 public:
  /// As of `FieldStars`.
  StarLayer(const SensorConfig& sensor, std::shared_ptr<const StarMap> map, double faintest_v_mag);

  const FieldStars& field() const { return field_; }

  /// Adds the stars' light that gets past `mask` to `image`; returns how many left some in the
  /// frame. `truth`, if not null, gets each of them. What air, Earth and blur cost is
  /// added to their `times`.
  std::uint32_t draw(const View& view, OpticsStage& optics, const OcclusionMask& mask,
                     ExpectedElectronImage& image, double faintest_v_mag,
                     std::vector<StarTruth>* truth, EffectTimes& times) const;

 private:
  std::uint32_t draw(const StarExposure& exposure, std::vector<StarTrail> trails, double may_miss_e,
                     OpticsStage& optics, const OcclusionMask& mask, ExpectedElectronImage& image,
                     std::vector<StarTruth>* truth, EffectTimes& times) const;
  std::vector<double> signals_e(const StarExposure& exposure, const std::vector<StarTrail>& trails,
                                EffectTimes& times) const;
  std::uint32_t draw_synthetic(const SyntheticStars& synthetic, StarExposure& exposure,
                               OpticsStage& optics, const OcclusionMask& mask,
                               ExpectedElectronImage& image, std::vector<StarTruth>* truth,
                               EffectTimes& times) const;

  FieldStars field_;
  StarLight light_;
};

}  // namespace dmise
