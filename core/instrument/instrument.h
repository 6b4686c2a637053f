#pragma once
#include "core/instrument/clock_error.h"
#include "core/instrument/pointing_error.h"
#include "core/instrument/vibration.h"

namespace dmise {

/// In the order in which they run.
using InstrumentEffects = EffectList<ClockError, PointingError, Vibration>;

/// What a sensor does not know of itself.
struct Instrument : InstrumentEffects::Parameters {
  bool operator==(const Instrument&) const = default;
};

/// Without the effects that are off.
Instrument acting_instrument(const Instrument& instrument, const EffectSet& effects);

}  // namespace dmise
