#pragma once
#include <string_view>

#include "core/orbit/elements/catalogue.h"
#include "core/orbit/elements/record.h"

namespace dmise {

/// Parses the catalogue number in the five columns of a TLE: digits with leading blanks, or Alpha-5
/// (a letter other than I and O for the first two digits, A0000 = 100000 to Z9999 = 339999). Throws
/// `RecordError`. Source: space-track.org, "Alpha-5".
std::uint32_t parse_alpha5(std::string_view columns);

/// Sum of digits, and of 1 for each '-', modulo 10, over the first 68 columns.
int tle_checksum(std::string_view line);

/// Parses the two lines of a TLE. Columns after the 69th are ignored if the 70th is blank. Blanks
/// count as zeros in leading digits and in a blank derivative, drag term, type or number. Ephemeris
/// types 0, 2 and 3 (all SGP4/SDP4) are accepted. With `lenient`, defects allowed by
/// `CatalogueOptions::lenient` are described in `warning`. Throws `RecordError`. Source: Vallado et
/// al., AIAA 2006-6753, appendix B, with the conversions of its code.
MeanElements parse_tle(std::string_view line1, std::string_view line2, bool lenient = false,
                       std::string* warning = nullptr);

/// Reads TLE or 3LE text into `file`. Lines that begin with '#' are comments.
void read_tle(std::string_view text, bool lenient, CatalogueFile& file);

/// Reads gpredict's satellites.dat into `file`: `[number]` sections with NAME, TLE1 and TLE2.
void read_gpredict(std::string_view text, bool lenient, CatalogueFile& file);

}  // namespace dmise
