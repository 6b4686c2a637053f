#pragma once
#include <array>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include "core/effects/plan_facts.h"

// What a sensor does not know of itself: frames are made as the sensor truly is, and their headers
// say what it believes. Such an effect is a struct of its parameters, all 0 by default, with
//   static constexpr EffectFacts facts;       its name is the key of its parameters in YAML
//   static std::span<const InstrumentParameter> parameters();
//   bool applies() const;                     whether a parameter is not 0
//   std::string_view fault() const;           optional: why parameters do not go together
//   ErrorBound error(int level, const PlanFacts&)   of a frame without it
// To add one: write its file pair, list it in core/instrument/instrument.h, test it.
namespace dmise {

struct Instrument;

/// Right, down and about the boresight of an image.
using ImageAxes = std::array<double, 3>;

/// A parameter of such effects, for YAML, digests, `dmise check` and documents. It stands in
/// digests when it is not 0.
struct InstrumentParameter {
  enum class Kind {
    number,
    axes,         // a list [x, y, roll]
    rms,          // >= 0
    rms_of_axes,  // >= 0; in YAML also one number, that of x and y
    list,         // of numbers >= 0, as many as there are
  };
  std::string_view key;  // in YAML
  double unit = 1.0;     // of the key in that of the member
  double most = 0.0;     // size of the number, in the unit of the key
  Kind kind = Kind::number;
  std::variant<double Instrument::*, ImageAxes Instrument::*, std::vector<double> Instrument::*>
      value;
};

}  // namespace dmise
