#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/base/numeric/rng.h"
#include "core/forces/earth_surroundings.h"
#include "core/frames/geodesy.h"
#include "core/orbit/motion_state.h"
#include "core/photometry/diffuse_sphere.h"
#include "core/tracking/predict.h"

namespace dmise {

/// A sensor on the ground that looks at an object whenever it can.
struct OrbitWatcher {
  std::string name;
  Site site;
  double sigma_rad = 0.0;  // error of a direction, along each axis
  double limiting_magnitude = 0.0;
  double cadence_s = 30.0;
  double min_elevation_rad = 0.0;
  int most_of_a_pass = 1000000;  // exposures
  bool spread = false;           // from the pass's begin to its end, instead of at once
  double exposure_s = 20.0;
  double half_angle_rad = 1.6;  // half of the field
};

/// An exposure of a watcher with the object in its sky.
struct WatchedExposure {
  const OrbitWatcher* watcher = nullptr;
  std::uint32_t number = 0;  // index of the instant
  SimTime time;
  Vec<Gcrs> sensor_m, sensor_m_per_s, direction, sun_m;
  std::optional<SeenMotion> seen;  // null: missed
};

/// Draws what a watcher sees of a place and velocity; words of `key` from `draw` on.
SeenMotion drawn_motion(const OrbitWatcher& watcher, SimTime time, const Vec<Gcrs>& sensor_m,
                        const Vec<Gcrs>& sensor_m_per_s, const MotionState<Gcrs>& object,
                        const RngKey& key, std::uint32_t draw);

/// Eight all-sky cameras: 20 s exposures every 30 s to magnitude 7, errors of 20 arcsec. Two
/// telescopes of 0.4 m, one in either hemisphere: three exposures of a pass at 1 arcsec, as a task
/// of the fusion node. Sites from 78 N to 44 S.
std::vector<OrbitWatcher> wide_network();
/// Such cameras at the eight sites of launch/scenarios/survey.yaml, 40 N to 32 S.
std::vector<OrbitWatcher> survey_network();

/// What watchers detect of one object on a given path, without pixels: directions with errors while
/// the Sun lights it, in the dark, above an elevation. Passes are apart by a quarter of an hour.
class WatchedOrbit {
 public:
  using Truth = std::function<MotionState<Gcrs>(SimTime)>;
  WatchedOrbit(const Clock& clock, const Truth& truth, SimTime from, SimTime to,
               const DiffuseSphere& sphere);

  struct Draw {
    double detection_probability = 0.83;  // as the score of the all-sky camera has it
    std::uint64_t seed = 1;
  };
  /// Exposures with the object in the sky, in order of time. They refer to `watchers`.
  std::vector<WatchedExposure> exposures(const std::vector<OrbitWatcher>& watchers,
                                         const Draw& draw) const;
  /// Passes, one after another, each in order of time.
  std::vector<std::vector<AngleObservation>> passes(const std::vector<OrbitWatcher>& watchers,
                                                    const Draw& draw) const;

 private:
  struct Instant {
    SimTime time;
    MotionState<Gcrs> state;
    Rotation<Gcrs, Itrs> gcrs_from_itrs;
    Vec<Gcrs> sun_m;
    bool lit = false;
  };
  bool sees(const OrbitWatcher& watcher, const Instant& now) const;
  /// Instants at which a watcher exposes.
  std::vector<std::size_t> looks(const OrbitWatcher& watcher) const;

  DiffuseSphere sphere_;
  std::vector<Instant> instants_;
};

}  // namespace dmise
