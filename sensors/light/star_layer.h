#pragma once
#include <memory>
#include <span>
#include <vector>

#include "core/base/image.h"
#include "core/base/parallel.h"
#include "core/photometry/star_light.h"
#include "core/sky/stars/star_cache.h"
#include "core/sky/stars/synthetic_stars.h"
#include "sensors/scene/occlusion_mask.h"
#include "sensors/scene/optics_stage.h"
#include "sensors/scene/view.h"

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
  PixelPosition start, middle, end;  // of its trail, also beside the frame
};

/// The star background: every star of the field with its own place and its own trail, and the
/// synthetic ones that go on where the catalogue ends.
class StarLayer {
 public:
  /// `faintest_v_mag`: of the catalogue's stars that are drawn.
  StarLayer(const SensorConfig& sensor, std::shared_ptr<const StarMap> map, double faintest_v_mag);

  const std::shared_ptr<const StarMap>& map() const { return map_; }

  /// Which stars are drawn one by one, by the limit of the catalogue's and an exposure's effects.
  DrawnStars drawn(double limit_v_mag, const EffectSet& effects) const;

  /// How many stars of the catalogue have a path over the frame or within `margin_px` of it; none
  /// is drawn.
  std::uint32_t count(const View& view, double faintest_v_mag, double margin_px) const;

  /// How many synthetic stars the frame is expected to hold at the level of `effects`, by the
  /// counts at 24 x 24 places of it, whatever the catalogue has of them.
  double expected_synthetic(const View& view, const EffectSet& effects) const;

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
  std::uint32_t draw_synthetic(StarExposure& exposure, OpticsStage& optics,
                               const OcclusionMask& mask, ExpectedElectronImage& image,
                               std::vector<StarTruth>* truth, EffectTimes& times) const;
  std::vector<std::uint32_t> candidates(const View& view, double faintest_v_mag) const;
  double synthetic_limit_v_mag(const EffectSet& effects) const;

  std::shared_ptr<const StarMap> map_;
  std::unique_ptr<const SyntheticStars> synthetic_;  // null: there are none
  /// Synthetic stars go to the frame's limit, by its level of `synthetic_stars`: at its reference
  /// nobody has set one, and none is drawn.
  bool to_frame_limit_ = false;
  StarLight light_;
  double faintest_filled_v_mag_;  // V to which the catalogue goes
};

}  // namespace dmise
