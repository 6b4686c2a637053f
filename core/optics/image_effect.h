#pragma once
#include <span>
#include <string_view>

#include "core/base/image.h"
#include "core/base/parallel.h"
#include "core/effects/effects.h"

// Optics that act on the whole image after every source is on it. Such an effect is a struct of its
// parameters with
//   static constexpr EffectFacts facts;
//   static std::span<const ImageParameter> parameters();
//   void switch_off();                      leaves it parameters with which it does nothing
//   bool applies() const;                   whether it has something to do
//   apply(ExpectedElectronImage&, Threads&) const;
// To add one: write its file pair, list it in core/optics/image_optics.h, test it.
namespace dmise {

struct ImageOptics;

/// A number of such optics, for all that treats them alike: YAML, FITS cards, digests, `dmise
/// check`, docs. It stands in headers and digests when it is not at its default.
struct ImageParameter {
  std::string_view key;      // in YAML: the field's name
  std::string_view keyword;  // in FITS
  std::string_view meaning;  // with the unit; comment of the FITS card
  double ImageOptics::*value;
  double least = 0.0, most = 1.0;
};

}  // namespace dmise
