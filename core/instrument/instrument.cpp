#include "core/instrument/instrument.h"

namespace dmise {

Instrument acting_instrument(const Instrument& instrument, const EffectSet& effects) {
  Instrument acting = instrument;
  InstrumentEffects::for_each([&]<class Effect>() {
    if (!effects.has(Effect::facts)) static_cast<Effect&>(acting) = {};
  });
  return acting;
}

}  // namespace dmise
