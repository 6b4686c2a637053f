#pragma once
#include <span>

#include "core/detector/detector.h"

// One table for all that treats a detector's figures alike: reading a camera's YAML, checking, FITS
// cards, the digest of a run. To add a figure: a field in `Detector`, a row here.
namespace dmise {

struct DetectorFigure {
  const char* key;      // in YAML and in messages: the field's name
  const char* keyword;  // in FITS; empty when the frame's header has it already
  const char* comment;  // of the FITS card, with the unit
  double Detector::*value;
  double least, most;
  bool least_open = false;  // `least` itself is refused
  bool required = false;    // in YAML
};

std::span<const DetectorFigure> detector_figures();

inline constexpr int most_adc_bits = 16;
inline constexpr int most_reference_px = 1000;

}  // namespace dmise
