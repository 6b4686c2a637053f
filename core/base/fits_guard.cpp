#include "core/base/fits_guard.h"

#include <algorithm>
#include <cstdlib>
#include <iterator>

#include "core/base/error.h"
#include "core/base/text_fields.h"

namespace dmise {

namespace {

constexpr std::size_t card_size = 80, value_at = 10, block_size = 2880;
constexpr std::size_t longest_number = 30;
constexpr double largest_file = 1e15;

// CFITSIO reads these as numbers, and a long text overflows its message about it.
constexpr std::string_view numbers[] = {
    "NAXIS", "BITPIX", "PCOUNT", "GCOUNT",  "BZERO",   "BSCALE",  "TFIELDS", "THEAP",
    "TZERO", "TSCAL",  "ZNAXIS", "ZBITPIX", "ZPCOUNT", "ZGCOUNT", "ZBLANK",  "ZDITHER"};

std::string keyword_of(std::string_view card) {
  return std::string(card.substr(0, std::min<std::size_t>(8, card.find_first_of(" ="))));
}

/// Returns the value of a card as a number, 0 if it is none; throws for a harmful card. `divides`:
/// whether CFITSIO divides by parameters of the compression.
double checked_value(std::string_view card, bool divides, const std::string& name) {
  const auto fail = [&](const std::string& reason) {
    throw ConfigError(name + ": " + keyword_of(card) + ": " + reason);
  };
  if (std::any_of(card.begin(), card.end(), [](char c) { return c < ' ' || c > '~'; }))
    throw ConfigError(name + ": a header holds bytes that are not printable ASCII");
  std::string_view value = card.substr(value_at - 1);
  value.remove_prefix(std::min(value.size(), value.find_first_not_of(' ')));
  const bool quoted = value.starts_with('\'');
  value = value.substr(0, value.find('/'));
  while (value.ends_with(' ')) value.remove_suffix(1);
  // CFITSIO makes a whole number of texts and of fractions, too: those may be 0.
  if (card.starts_with("ZTILE") || (divides && card.starts_with("ZVAL"))) {
    if (card.substr(8, 1) != "=" || parse_count(value).value_or(0) == 0)
      fail("must be a whole number > 0");
  }
  if (quoted && std::any_of(std::begin(numbers), std::end(numbers),
                            [&](std::string_view key) { return card.starts_with(key); }))
    fail("must be a number");
  if (card.substr(8, 1) != "=" || quoted) return 0.0;
  if (value.size() > longest_number) fail("is too long for a number");
  return std::strtod(std::string(value).c_str(), nullptr);
}

}  // namespace

std::size_t require_harmless_headers(std::string_view bytes, const std::string& name) {
  std::size_t at = 0;
  while (at + card_size <= bytes.size()) {
    double bits = 8, elements = 0, extra = 0, groups = 1;
    bool ended = false, has_form = false, divides = true;
    for (; !ended && at + card_size <= bytes.size(); at += card_size) {
      const std::string_view card = bytes.substr(at, card_size);
      const double value = checked_value(card, divides, name);
      const std::string key = keyword_of(card);
      ended = key == "END";
      if (key == "ZCMPTYPE") {
        if (has_form) throw ConfigError(name + ": ZCMPTYPE: is there twice");
        has_form = true;
        divides = card.find("'RICE_") != card.npos;
      }
      if (key == "BITPIX") bits = std::abs(value);
      if (key == "PCOUNT") extra = value;
      if (key == "GCOUNT") groups = value;
      if (key == "NAXIS") elements = value > 0 ? 1 : 0;
      if (key.starts_with("NAXIS") && key.size() > 5) elements *= value;
    }
    const double data = bits / 8 * groups * (extra + elements);
    if (!ended || !(data >= 0 && data < largest_file)) break;
    at = (at + block_size - 1) / block_size * block_size;
    at += (static_cast<std::size_t>(data) + block_size - 1) / block_size * block_size;
  }
  return at;
}

void require_bytes(std::string_view bytes, std::size_t asked, const std::string& name) {
  if (bytes.size() < asked)
    throw ConfigError(name + ": is truncated: " + std::to_string(bytes.size()) + " of " +
                      std::to_string(asked) + " bytes");
}

}  // namespace dmise
