#pragma once
#include <array>

#include "core/tracking/predict.h"

namespace dmise {

/// What a source that is the light of two objects at once tells of each.
struct BlendedPair {
  std::array<AngleObservation, 2> parts;  // directions of either, wide enough for both's errors
  // Chi-square of the source from the predicted centre of light, 2 degrees of freedom.
  double d2 = 0.0;
};

/// The source lies at the centre of both objects' light, of which the first has `share`, (0, 1). If
/// the other is where it is predicted to be, this gives the direction of the one: the best update
/// of either by the joint estimate of both, without the correlation that it makes between them
/// (Koch & van Keuk 1997, IEEE Trans. AES 33, 883).
BlendedPair blended_pair(const AngleObservation& seen, const PredictedDirection& first,
                         const PredictedDirection& second, double share);

}  // namespace dmise
