#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/products/frame_header.h"

namespace dmise {

/// The header as FITS cards of 80 characters, WCS included, without the structural ones (SIMPLE ...
/// BZERO). Numbers are the shortest text that reads back to the same bits. Throws `Error` with the
/// keyword when a value is not finite or a text does not fit.
std::vector<std::string> fits_cards(const FrameHeader& header);

/// One card. Throws `Error` as `fits_cards` does.
std::string text_card(const std::string& key, const std::string& value, const std::string& comment);
std::string flag_card(const std::string& key, bool value, const std::string& comment);
std::string number_card(const std::string& key, double value, const std::string& comment);
std::string integer_card(const std::string& key, std::int64_t value, const std::string& comment);

/// Keyword -> value of cards; texts without quotes, comments dropped, of doubles the first.
using FitsValues = std::map<std::string, std::string>;
void add_card(FitsValues& values, const std::string& card);

/// The header that the cards state. Throws `ConfigError` "NAME: KEYWORD: reason".
FrameHeader header_from_values(const FitsValues& values, const std::string& name);

/// The header as it reads back from its own file (angles pass through degrees there): what a
/// detector is given, so that detecting in memory and from the file are the same.
FrameHeader as_in_file(const FrameHeader& header);

}  // namespace dmise
