#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "core/sky/faint_starlight.h"
#include "core/sky/stars/star_map.h"
#include "core/sky/stars/synthetic_stars.h"
#include "sensors/scene/view.h"

namespace dmise {

/// How far the boresight turns from where it is in mid exposure.
double turned_rad(const View& view);

/// The stars of a sensor's fields before they are drawn: which are drawn one by one, those of the
/// catalogue and synthetic ones that go on where it ends.
class FieldStars {
 public:
  /// `faintest_v_mag`: of the catalogue's stars that are drawn.
  FieldStars(const SensorConfig& sensor, std::shared_ptr<const StarMap> map, double faintest_v_mag);

  const std::shared_ptr<const StarMap>& map() const { return map_; }
  const SyntheticStars* synthetic() const { return synthetic_.get(); }  // null: there are none
  /// Whether synthetic stars go to the frame's limit, by its level of `synthetic_stars`: at its
  /// reference nobody has set one, and none is drawn.
  bool to_frame_limit() const { return to_frame_limit_; }

  /// Which stars are drawn one by one, by the limit of the catalogue's and an exposure's effects.
  DrawnStars drawn(double limit_v_mag, const EffectSet& effects) const;

  /// How many stars of the catalogue have a path over the frame or within `margin_px` of it; none
  /// is drawn.
  std::uint32_t count(const View& view, double faintest_v_mag, double margin_px) const;

  /// How many synthetic stars the frame is expected to hold at the level of `effects`, by the
  /// counts at 24 x 24 places of it, whatever the catalogue has of them.
  double expected_synthetic(const View& view, const EffectSet& effects) const;

  /// To which magnitude there are synthetic stars with these effects.
  double synthetic_limit_v_mag(const EffectSet& effects) const;

  /// Stars of the catalogue around the boresight of mid exposure, wide enough for the field to have
  /// turned.
  std::vector<std::uint32_t> candidates(const View& view, double faintest_v_mag) const;

 private:
  std::shared_ptr<const StarMap> map_;
  std::unique_ptr<const SyntheticStars> synthetic_;
  bool to_frame_limit_ = false;
};

}  // namespace dmise
