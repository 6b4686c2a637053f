#pragma once
#include "sensors/scene/view.h"

namespace dmise {

/// Expected electrons that Sun, Moon and the lit Earth beside the field leave in every pixel by the
/// camera's point source transmittance, in the middle of the exposure: the irradiance of the
/// aperture, square to each source, times the transmittance at its angle from the boresight. A body
/// whose centre is in the frame, and what of the Earth is, gives none; on the ground the air dims
/// Sun and Moon. 0 where the effect does not act.
double stray_light_e(const View& view);

}  // namespace dmise
