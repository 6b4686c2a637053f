#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "core/base/parallel.h"
#include "core/score/score.h"

namespace dmise {

/// Frames that the program draws from a seed, with what it detects in them, scored. Their sensors
/// are `streak_sensor` and `point_sensor`, each with `few_stars` or `many_stars` after it.
struct ScoredDraws {
  using Name = std::pair<std::string, std::string>;  // frame, and the truth's id
  Score score;
  std::map<Name, double> probability;  // that the model of `dmise survey` gives
  std::map<Name, double> star_px;      // from a point to the nearest trail that stands out
  double expected(const TrueSource& truth) const;
};

/// Satellites are streaks among round stars, or points among trails.
inline constexpr const char* streak_sensor = "streaks";
inline constexpr const char* point_sensor = "points";
/// Frames with fewer stars, and the others.
inline constexpr const char* few_stars = "_sparse";
inline constexpr const char* many_stars = "_dense";
inline constexpr std::uint32_t stars_of_dense_frame = 3000;

/// Draws `frames` exposures of each sensor, with 16 objects in each whose expected SNR is uniform
/// in its logarithm from 3 to 100.
ScoredDraws draw_frames(int frames, std::uint64_t seed, Threads& threads);

}  // namespace dmise
