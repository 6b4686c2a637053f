#include "core/sim/state.h"

#include <algorithm>

namespace dmise {

std::optional<AttitudeState> ObjectStates::attitude(std::size_t i) const {
  const auto found = std::lower_bound(attitude_object.begin(), attitude_object.end(), i);
  if (found == attitude_object.end() || *found != i || code[i] != 0) return std::nullopt;
  const std::size_t m = attitude_object.size();
  const auto k = static_cast<std::size_t>(found - attitude_object.begin());
  const double *q = gcrs_from_body.data() + k, *w = attitude_rate_rad_per_s.data() + k;
  return AttitudeState{{q[0], q[m], q[2 * m], q[3 * m]}, {w[0], w[m], w[2 * m]}};
}

}  // namespace dmise
