#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "core/config/scenario_draws.h"
#include "core/sky/stars/star_map.h"
#include "sensors/dataset/frame_labels.h"

namespace dmise {

inline constexpr std::uint64_t max_sample_seed = 999'999'999;  // keys have nine digits for it

/// One frame of a sample, as it goes into an archive.
struct SampleFrame {
  std::string key;      // "000000012-atlanta-000001": seed, sensor, frame
  std::string members;  // tar members: KEY.image.npy, KEY.mask.npy, KEY.labels.json, KEY.fits
  std::string coco_image;
  std::vector<std::string> coco_annotations;
};

/// Makes the frames of scenarios in this process and labels them. Keeps star catalogues.
class SampleMaker {
 public:
  /// Takes a frame when it is made; `sensor` is its number in the scenario.
  using FrameTaker =
      std::function<void(std::size_t sensor, const LabelledFrame&, const LabelImage& mask)>;

  /// `digest`: of the data set, written into labels and frames.
  explicit SampleMaker(std::string digest) : digest_(std::move(digest)) {}

  /// Loads the star catalogue of a scenario, so that processes forked later share it, and checks
  /// that its sensors have the platforms and targets that they name, and that its trajectories and
  /// tables cover its times. Quick for what is like before.
  void prepare(const Scenario& scenario);
  /// Hands over each frame when it is made. Throws what a run throws.
  void make(const DrawnScenario& sample, const FrameTaker& take);
  /// Returns the frames of all sensors, by sensor and frame.
  std::vector<SampleFrame> make(const DrawnScenario& sample);

 private:
  std::string digest_;
  // By the paths of the catalogue and of its variable stars.
  std::map<std::pair<std::string, std::string>, std::shared_ptr<const StarMap>> stars_;
  std::set<std::string> checked_;  // names of objects
};

}  // namespace dmise
