#pragma once
#include <optional>
#include <span>
#include <vector>

#include "core/score/score_input.h"

namespace dmise {

/// Which detections belong to which truth in one frame; indices into the given lists.
struct Association {
  std::vector<std::optional<std::size_t>> detection_of_truth;
  // Further detections of a truth that was found in pieces.
  std::vector<std::vector<std::size_t>> pieces_of_truth;
  std::vector<std::size_t> false_alarms;
};

/// A detection may belong to a truth if its centroid and at least half of its line are within
/// `gate_px` of the true trail. Takes as many of these pairs as possible, one to one, and of
/// equally many those with the least sum of squared normalised distances: across the trail over
/// `gate_px`, along it from the centroid of its light over half its length plus `gate_px` (optimal,
/// by shortest augmenting paths). A detection left over that may belong to a truth is a piece of
/// it. Truth without light is paired with none.
Association associate(std::span<const TrueSource> truths, std::span<const FoundSource> detections,
                      double gate_px);

}  // namespace dmise
