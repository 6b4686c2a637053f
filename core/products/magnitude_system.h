#pragma once

namespace dmise {

/// The system of all magnitudes of frames, detections and truth: the V (Vega) of a source of the
/// Sun's colour that is as bright in the band.
inline constexpr const char* magnitude_system = "V-solar";

}  // namespace dmise
