#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

#include "core/base/image.h"
#include "core/base/numeric/rng.h"
#include "core/base/numeric/simd_level.h"
#include "core/base/parallel.h"
#include "core/detector/noise/pixel_flags.h"
#include "core/effects/accuracy.h"
#include "core/effects/effects.h"

// A detector effect maps expected electrons or electrons to electrons or counts. It is a struct of
// its parameters with
//  static constexpr EffectFacts facts;
//  static std::span<const ParameterOf<ITS NAME>> parameters();
//  void switch_off();                    sets parameters with which it does nothing
//  bool applies(const Detector&) const;  whether it changes anything in a frame
//  apply(const ExposureFacts&, Piece&) const                         on a piece of the image, or
//  apply(const ExposureFacts&, const ElectronImage&, Piece&) const   with neighbouring pixels, or
//  apply(const ExposureFacts&, const WholeImage&) const              on the whole image
//      or none, if it acts where light is drawn (sensors/light)
// and optionally
//  Prepared prepare(const ExposureFacts&) const;
//      called before the first pixel; its result is passed to `apply` after the facts
//  static std::optional<DetectorFault> fault(const Detector&);
//      returns an invalid combination of parameters
//  ErrorBound error(int level, const PlanFacts&) const;  of a level below the reference; without it
//      the effect is not planned
//  static double cost_s(int level, const PlanFacts&);    of a level; without it 0
// To add one: write its file pair, list it in core/detector/detector.h, test it.
namespace dmise {

struct Detector;
struct PersistenceMemory;

/// Identifies the random numbers of an exposure, and its times.
struct Exposure {
  std::uint64_t seed = 0;
  std::string sensor;  // its name
  std::uint32_t frame = 0;
  double exposure_s = 0.0;  // >= 0
  double idle_s = 0.0;      // since the end of the previous exposure, for persistence; >= 0
};

/// Number of pixels that reached a limit.
struct SaturatedPixels {
  std::size_t full_well = 0;
  std::size_t adc = 0;  // at the highest count that the ADC or the 16-bit image holds

  bool operator==(const SaturatedPixels&) const = default;
};

/// Inputs of an effect in one exposure.
struct ExposureFacts {
  const ExpectedElectronImage& light;
  const Detector& detector;  // from acting_detector()
  const Exposure& exposure;
  PersistenceMemory& traps;
  SimdLevel level;
  RngKey key;        // for random numbers of this frame
  RngKey fixed_key;  // for random numbers common to all frames of the sensor
};

/// A run of pixels in the chain. Starts at a multiple of rng_group.
struct Piece {
  std::size_t first = 0;  // index of the first in the image
  std::span<float> electrons;
  std::span<std::uint8_t> flags;  // sums of PixelFlag; empty: not requested
  std::uint16_t* counts = nullptr;
  SaturatedPixels* saturated = nullptr;
};

/// All pixels.
struct WholeImage {
  ElectronImage& electrons;
  FlagImage* flags;  // null: not requested
  Threads& threads;
  SaturatedPixels& saturated;
};

/// One parameter of an effect, or of a whole detector (DetectorParameter), for YAML, checks, FITS
/// cards, digests, `dmise check` and the docs.
template <class Owner>
struct ParameterOf {
  std::string_view key;      // in YAML and in messages: the field's name
  std::string_view keyword;  // in FITS; empty if the frame's header has it elsewhere
  std::string_view meaning;  // with the unit; comment of the FITS card
  std::variant<double Owner::*, int Owner::*, bool Owner::*> value;
  double least = 0.0, most = 1.0;
  bool least_open = false;       // `least` itself is refused
  bool required = false;         // in YAML
  std::string_view reason = {};  // why the range is so, for messages

  double number_of(const Owner& owner) const {
    return std::visit([&](auto member) { return double(owner.*member); }, value);
  }
  void set(Owner& owner, double number) const {
    std::visit(
        [&](auto member) {
          auto& field = owner.*member;
          field = static_cast<std::remove_reference_t<decltype(field)>>(number);
        },
        value);
  }
  /// The parameter as one of a class that has the owner as its base.
  template <class Derived>
  ParameterOf<Derived> in() const {
    const auto its = std::visit(
        [](auto member) {
          using Field = std::remove_reference_t<decltype(std::declval<Owner&>().*member)>;
          return decltype(ParameterOf<Derived>::value)(static_cast<Field Derived::*>(member));
        },
        value);
    return {key, keyword, meaning, its, least, most, least_open, required, reason};
  }
};
using DetectorParameter = ParameterOf<Detector>;

/// An invalid parameter.
struct DetectorFault {
  std::string key, reason;  // the field's name; "must be ..."
  double got = 0.0;
};

}  // namespace dmise
