#pragma once
#include <span>
#include <string>

#include "core/orbit/elements/elements.h"

namespace dmise {

/// The two lines of a TLE with checksums, ready for `parse_tle`. Throws `Error` for a catalogue
/// number beyond Alpha-5's 339999.
std::string format_tle(const MeanElements& elements);

/// A catalogue as 3LE ("0 NAME" before each set).
std::string format_3le(std::span<const MeanElements> catalogue);

/// International designator "98067A" as an OMM writes it, "1998-067A".
std::string omm_designator(const std::string& id);

/// A catalogue as OMM in CSV: numbers of up to 9 digits.
std::string format_omm_csv(std::span<const MeanElements> catalogue);

}  // namespace dmise
