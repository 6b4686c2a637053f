#pragma once
#include <span>
#include <string>
#include <vector>

#include "core/frames/earth_orientation.h"
#include "core/fusion/fusion_settings.h"
#include "core/orbit/sgp4/sgp4_batch.h"
#include "core/time/clock.h"
#include "core/tracking/orbit_state.h"

namespace dmise {

/// Where the objects of a catalogue are, and how well that is known.
class CataloguePrediction {
 public:
  CataloguePrediction(std::vector<MeanElements> elements, const Clock& clock,
                      const FusionSettings& settings);

  /// Computes the states of all objects at a time.
  void move(SimTime time);

  std::size_t size() const { return elements_.size(); }
  const MeanElements& elements(std::size_t i) const { return elements_[i]; }
  SimTime time() const { return time_; }
  /// Whether object `i` has a state.
  bool known(std::size_t i) const { return code_[i] == 0; }
  Vec<Gcrs> position_m(std::size_t i) const { return gcrs_from_teme_ * at(position_m_, i); }
  Vec<Gcrs> velocity_m_per_s(std::size_t i) const {
    return gcrs_from_teme_ * at(velocity_m_per_s_, i);
  }
  /// All x, all y, all z; 0 without a state.
  std::span<const double> teme_m() const { return position_m_; }
  const Rotation<Gcrs, Teme>& gcrs_from_teme() const { return gcrs_from_teme_; }

  /// Largest standard deviation of the position [m].
  double sigma_m(std::size_t i) const;
  /// State with its covariance: the settings' along the radius, the motion and the orbit's normal,
  /// and of the velocity those times the mean motion, of the radius and the motion exchanged.
  OrbitEstimate estimate(std::size_t i) const;

 private:
  Vec<Teme> at(const std::vector<double>& xyz, std::size_t i) const {
    return {xyz[i], xyz[size() + i], xyz[2 * size() + i]};
  }
  double sigma_m(std::size_t i, std::size_t axis) const;

  std::vector<MeanElements> elements_;
  Clock clock_;
  FusionSettings settings_;
  Sgp4Batch batch_;
  SimTime time_;
  Utc utc_;
  Rotation<Gcrs, Teme> gcrs_from_teme_;
  std::vector<double> position_m_, velocity_m_per_s_;
  std::vector<std::uint8_t> code_;
};

}  // namespace dmise
