#pragma once
#include <array>
#include <optional>
#include <vector>

#include "core/effects/plan_facts.h"
#include "core/photometry/star_light.h"
#include "core/sky/faint_starlight.h"
#include "sensors/sky/field_stars.h"

namespace dmise {

/// What is known of the stars of one sensor's fields before they are drawn.
class StarFacts {
 public:
  /// `stars`: null for none; must outlive it.
  StarFacts(const SensorConfig& sensor, const StarMap* stars, double faintest_v_mag);

  /// Returns which stars are drawn one by one at most.
  const DrawnStars& drawn() const { return drawn_; }

  /// Whether synthetic stars end where none stands out of a frame's noise.
  bool to_frame_limit() const { return field_ && field_->to_frame_limit(); }

  /// Sets what is known of the stars in an exposure. The sky's facts must be there.
  void add(const View& view, PlanFacts& facts) const;

 private:
  void add_trails(const View& view, PlanFacts& facts) const;
  void add_stars(const View& view, PlanFacts& facts) const;
  void add_synthetic(const SyntheticStars& synthetic, const Vec<Gcrs>& axis, double seen_rad,
                     double electrons, PlanFacts& facts) const;

  /// Stars by whole V magnitudes: those not fainter, and the light of the brightest beyond
  /// [photons/s/m2]; the brightest of all, and how many were looked at.
  struct ByLimit {
    std::array<double, star_limits> count{}, beyond{};
    double brightest = 0.0, processed = 0.0;

    void add(double v_mag, double photons, double stars = 1.0);
    void sum_up();
  };

  void sum_up(const StarMap& map);
  ByLimit counted(const View& view, const PlanFacts& facts, double radius_rad) const;

  const StarMap* stars_;
  double faintest_v_mag_;
  DrawnStars drawn_;
  std::optional<FieldStars> field_;  // where synthetic stars may be drawn
  StarLight light_;
  ByLimit whole_sky_;
  double fastest_rad_per_yr_ = 0.0, largest_parallax_rad_ = 0.0;
};

}  // namespace dmise
