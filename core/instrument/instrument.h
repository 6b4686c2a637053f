#pragma once
#include "core/instrument/clock_error.h"
#include "core/instrument/pointing_error.h"
#include "core/instrument/vibration.h"

namespace dmise {

/// In the order in which they run.
using InstrumentEffects = EffectList<ClockError, PointingError, Vibration>;

/// The errors of a sensor that it does not know of.
struct Instrument : InstrumentEffects::Parameters {
  bool operator==(const Instrument&) const = default;
};

/// Returns the instrument without the errors that are switched off.
Instrument acting_instrument(const Instrument& instrument, const EffectSet& effects);

}  // namespace dmise
