#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "core/base/image.h"
#include "core/base/parallel.h"
#include "core/base/rng.h"
#include "core/base/simd_level.h"
#include "core/detector/pixel_flags.h"
#include "core/effects/effects.h"

// A detector effect takes expected electrons or electrons and gives electrons or counts. It is a
// struct of its parameters with
//   static constexpr EffectFacts facts;
//   static std::span<const DetectorParameter> parameters();
//   void switch_off();                    leaves it parameters with which it does nothing
//   bool applies(const Detector&) const;  whether it has something to do in a frame
//   apply(const ExposureFacts&, Piece&) const                        on a piece of the image, or
//   apply(const ExposureFacts&, const ElectronImage&, Piece&) const  likewise, by its neighbours,
//   or apply(const ExposureFacts&, const WholeImage&) const             on the whole image
// and, where it needs them,
//   Prepared prepare(const ExposureFacts&) const;  before the first pixel; `apply` is given it
//   after
//                                                  the facts
//   static std::optional<DetectorFault> fault(const Detector&);  what parameters together make
//   wrong
// To add one: write its file pair, list it in core/detector/detector.h, test it.
namespace dmise {

struct Detector;
struct PersistenceMemory;

/// What names an exposure's random numbers, and its length.
struct Exposure {
  std::uint64_t seed = 0;
  std::string sensor;  // its name
  std::uint32_t frame = 0;
  double exposure_s = 0.0;  // >= 0
  double idle_s = 0.0;      // since the end of the exposure before, for persistence; >= 0
};

/// Pixels that reached a limit.
struct SaturatedPixels {
  std::size_t full_well = 0;
  std::size_t adc = 0;  // at the highest count that the ADC or the 16-bit image holds

  bool operator==(const SaturatedPixels&) const = default;
};

/// What an effect may use of an exposure.
struct ExposureFacts {
  const ExpectedElectronImage& light;
  const Detector& detector;  // as it acts
  const Exposure& exposure;
  PersistenceMemory& traps;
  SimdLevel level;
  RngKey key;        // of the effect's random numbers in this frame
  RngKey fixed_key;  // of those that are the same in every frame of the sensor
};

/// Pixels on their way through the chain. They begin at a multiple of rng_group.
struct Piece {
  std::size_t first = 0;  // index of the first in the image
  std::span<float> electrons;
  std::span<std::uint8_t> flags;  // sums of PixelFlag; empty: not asked for
  std::uint16_t* counts = nullptr;
  SaturatedPixels* saturated = nullptr;
};

/// All pixels.
struct WholeImage {
  ElectronImage& electrons;
  FlagImage* flags;  // null: not asked for
  Threads& threads;
  SaturatedPixels& saturated;
};

/// A number of the detector, for all that treats them alike: YAML, checks, FITS cards, digests,
/// `dmise check`, docs.
struct DetectorParameter {
  std::string_view key;      // in YAML and in messages: the field's name
  std::string_view keyword;  // in FITS; empty when the frame's header has it already
  std::string_view meaning;  // with the unit; comment of the FITS card
  std::variant<double Detector::*, int Detector::*, bool Detector::*> value;
  double least = 0.0, most = 1.0;
  bool least_open = false;       // `least` itself is refused
  bool required = false;         // in YAML
  std::string_view reason = {};  // of the range, for messages

  double number_of(const Detector& detector) const;
  void set(Detector& detector, double number) const;
};

/// A parameter that no detector can have.
struct DetectorFault {
  std::string key, reason;  // the field's name; "must be ..."
  double got = 0.0;
};

}  // namespace dmise
