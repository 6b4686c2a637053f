#pragma once
#include <array>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include "core/effects/effects.h"

// Errors of a sensor that it does not know of: frames are made with them, and headers are written
// without. Such an effect is a struct of its parameters, all 0 by default, with
//   static constexpr EffectFacts facts;       its name is the key of its parameters in YAML
//   static std::span<const InstrumentParameter> parameters();
//   bool applies() const;                     whether a parameter is not 0
//   std::string_view fault() const;           optional: why parameters do not go together
//   ErrorBound error(int level, const PlanFacts&)   of a frame without it
// To add one: write its file pair, list it in core/instrument/instrument.h, test it.
namespace dmise {

struct Instrument;

/// Components along an image's columns (right), along its rows (down) and about the boresight.
using ImageAxes = std::array<double, 3>;

/// A parameter of such effects, for YAML, digests, `dmise check` and documents. Digests leave out
/// parameters that are 0.
struct InstrumentParameter {
  enum class Kind {
    number,
    axes,         // a list [x, y, roll]
    rms,          // >= 0
    rms_of_axes,  // >= 0; in YAML also one number, for x and y
    list,         // any number of numbers >= 0
  };
  std::string_view key;  // in YAML
  double unit = 1.0;     // factor from the key's unit to the member's
  double most = 0.0;     // largest absolute value, in the key's unit
  Kind kind = Kind::number;
  std::variant<double Instrument::*, ImageAxes Instrument::*, std::vector<double> Instrument::*>
      value;
  std::string_view meaning;  // with the unit, a sentence
};

}  // namespace dmise
