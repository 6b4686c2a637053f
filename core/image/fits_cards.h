#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/products/frame_header.h"

namespace dmise {

/// Returns the header as FITS cards of 80 characters, including the WCS but not the structural ones
/// (SIMPLE ... BZERO). Numbers are the shortest text that reads back to the same bits. Throws
/// `Error` with the keyword if a value is not finite or a text does not fit.
std::vector<std::string> fits_cards(const FrameHeader& header);

/// Returns one card. Throws `Error` as `fits_cards` does.
std::string text_card(const std::string& key, const std::string& value, const std::string& comment);
std::string flag_card(const std::string& key, bool value, const std::string& comment);
std::string number_card(const std::string& key, double value, const std::string& comment);
std::string integer_card(const std::string& key, std::int64_t value, const std::string& comment);

/// Values of cards by keyword: texts unquoted, comments dropped, the first of duplicates.
using FitsValues = std::map<std::string, std::string>;
void add_card(FitsValues& values, const std::string& card);

/// Parses a header from card values. Throws `ConfigError` "NAME: KEYWORD: reason".
FrameHeader header_from_values(const FitsValues& values, const std::string& name);

/// Returns the header as it reads back from its own file, where angles are in degrees. Detection in
/// memory uses this, so that detecting from the file gives the same bytes.
FrameHeader as_in_file(const FrameHeader& header);

}  // namespace dmise
