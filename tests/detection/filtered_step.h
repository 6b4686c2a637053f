#pragma once
#include <algorithm>
#include <cstdint>

#include "core/detection/pixels/filtered_frame.h"

namespace dmise::test {

/// The step of an SNR in a pixel whose column plus row is odd, or not.
inline std::int8_t step_of(float snr, bool odd) {
  constexpr auto most = float(FilteredFrame::most);
  const float scaled = std::clamp(snr * float(FilteredFrame::steps), -most, most);
  const int step = int(scaled + (scaled < 0 ? -0.5f : 0.5f));
  return std::int8_t(step != 0 ? step : odd ? 1 : -1);
}

}  // namespace dmise::test
