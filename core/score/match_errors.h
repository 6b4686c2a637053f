#pragma once
#include "core/score/score.h"

namespace dmise {

/// Errors of the detection of a truth with light; each is empty where either side does not know
/// the quantity.
MatchErrors errors_of(const ScoredTruth& truth, const Detection& detection,
                      const ScoredFrame& frame);

}  // namespace dmise
