#pragma once
#include <string>

#include "core/exchange/export_format.h"

namespace dmise {

/// A CZML document (one JSON list) of a run for CesiumJS: its clock; objects at the mid exposures
/// at which truth has them, or tracks at the ticks at which they have a state, in the INERTIAL
/// frame with velocities; sensors, FIXED on the ground and INERTIAL in orbit; the field of view of
/// each frame as a pyramid of lines. It has no property that begins with agi_.
std::string czml_text(const ExportRequest& request);

}  // namespace dmise
