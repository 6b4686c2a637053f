#include "core/base/files/fits_guard.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <optional>

#include "core/base/error.h"
#include "core/base/files/text_fields.h"
#include "core/base/files/text_file.h"
#include "core/base/formatted.h"

namespace dmise {

namespace {

constexpr std::size_t card_size = 80, value_at = 10, block_size = 2880;
constexpr std::size_t longest_number = 30;
constexpr std::size_t longest_header = std::size_t(1) << 24;
constexpr double largest_file = 1e15, max_axes = 99;

// CFITSIO reads these as numbers, and a long text overflows its message about it.
constexpr std::string_view numbers[] = {
    "NAXIS", "BITPIX", "PCOUNT", "GCOUNT",  "BZERO",   "BSCALE",  "TFIELDS", "THEAP",
    "TZERO", "TSCAL",  "ZNAXIS", "ZBITPIX", "ZPCOUNT", "ZGCOUNT", "ZBLANK",  "ZDITHER"};
// It converts these, too, whatever they hold.
constexpr std::string_view converted[] = {
    "SIMPLE", "EXTEND", "GROUPS", "XTENSION", "BLANK", "TNULL",    "TBCOL",  "TTYPE", "TFORM",
    "TDIM",   "TUNIT",  "TDISP",  "ZSCALE",   "ZZERO", "ZTILE",    "ZVAL",   "ZNAME", "ZCMP",
    "ZQUANT", "ZIMAGE", "ZMASK",  "EXT",      "HDU",   "LONGSTRN", "INHERIT"};

template <std::size_t N>
bool begins_with_one_of(std::string_view card, const std::string_view (&keys)[N]) {
  return std::any_of(std::begin(keys), std::end(keys),
                     [&](std::string_view key) { return card.starts_with(key); });
}

std::string_view keyword_of(std::string_view card) {
  return card.substr(0, std::min<std::size_t>(8, card.find_first_of(" =")));
}

/// Text of a card's value: without blanks around it and, if it is not quoted, its comment.
std::string_view value_of(std::string_view card) {
  std::string_view value = card.substr(value_at - 1);
  value.remove_prefix(std::min(value.size(), value.find_first_not_of(' ')));
  value = value.substr(0, value.find('/'));
  while (value.ends_with(' ')) value.remove_suffix(1);
  return value;
}

bool is_printable(char c) { return c >= ' ' && c <= '~'; }

/// Whether a header ends here: END, and blanks or what no keyword goes on with.
bool is_end(std::string_view card) {
  if (!card.starts_with("END")) return false;
  const std::size_t next = card.find_first_not_of(' ', 3);
  if (next == card.npos) return true;
  const char c = card[next];
  return !((c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-');
}

/// Checks and mends the cards of the header at `at`, one after another.
class HeaderScan {
 public:
  /// A card as the header has it, printable; returns what stands in its place, empty: itself.
  std::string take(std::string_view card, const std::string& name) {
    const std::string_view key = keyword_of(card);
    const auto fail = [&](const std::string& reason) {
      throw ConfigError(name + ": " + std::string(key) + ": " + reason);
    };
    std::string_view value = value_of(card);
    const bool quoted = value.starts_with('\'');
    // CFITSIO makes a whole number of texts and of fractions, too: those may be 0.
    if (card.starts_with("ZTILE") || (divides_ && card.starts_with("ZVAL"))) {
      if (card.substr(8, 1) != "=" || parse_count(value).value_or(0) == 0)
        fail("must be a whole number > 0");
    }
    const bool is_number = begins_with_one_of(card, numbers);
    if (quoted && is_number) fail("must be a number");
    std::string mended;
    double number = 0.0;
    if (card.substr(8, 1) == "=" && !quoted) {
      if (value.size() > longest_number && (is_number || begins_with_one_of(card, converted))) {
        const auto read = parse_real(value);
        if (!read && is_number) fail("is too long for a number");
        if (read) mended = std::string(card.substr(0, 8)) + "= " + shortest_text(*read);
        mended.resize(card_size, ' ');  // a blank card if CFITSIO can't take it for a number
      }
      if (value.size() <= longest_number || !mended.empty())
        number = std::strtod(std::string(value).c_str(), nullptr);
    }
    if (key == "ZCMPTYPE") {
      if (has_form_) fail("is there twice");
      has_form_ = true;
      divides_ = card.find("'RICE_") != card.npos;
    }
    if ((key == "NAXIS" || key == "ZNAXIS") && number > max_axes)
      fail("must be at most 99, got " + std::string(value));
    count(key, number);
    return mended;
  }

  /// Counts a card for the size of the data.
  void count(std::string_view key, double number) {
    if (key == "BITPIX") bits_ = std::abs(number);
    if (key == "PCOUNT") extra_ = number;
    if (key == "GCOUNT") groups_ = number;
    if (key == "NAXIS") {
      axes_ = number;
      elements_ = number > 0 ? 1 : 0;
    } else if (key.starts_with("NAXIS")) {
      const auto axis = parse_count(key.substr(5));
      if (axis && *axis >= 1 && *axis <= axes_) elements_ *= number;
    }
  }

  /// Bytes of data; empty if no file can hold them.
  std::optional<std::size_t> data_bytes() const {
    const double data = bits_ / 8 * groups_ * (extra_ + elements_);
    if (!(data >= 0 && data < largest_file)) return std::nullopt;
    return std::size_t(data);
  }

 private:
  double bits_ = 8, axes_ = 0, elements_ = 0, extra_ = 0, groups_ = 1;
  bool has_form_ = false, divides_ = true;
};

std::size_t padded(std::size_t size) { return (size + block_size - 1) / block_size * block_size; }

/// Cards as a list for a note, the first few of them.
std::string listed(const std::vector<std::string>& keys) {
  constexpr std::size_t most = 5;
  std::string text;
  for (std::size_t i = 0; i < std::min(most, keys.size()); ++i) text += (i ? ", " : "") + keys[i];
  if (keys.size() > most) text += " and " + std::to_string(keys.size() - most) + " more";
  return text;
}

/// How many bytes of a file are needed to read on, at most `have` and a block if it may end there.
std::size_t bytes_needed(std::string_view have) {
  std::size_t at = 0;
  while (at + card_size <= have.size()) {
    if (at > 0 && !have.substr(at).starts_with("XTENSION")) return have.size();
    HeaderScan scan;
    std::size_t end = at;
    bool ended = false;
    for (; !ended && end + card_size <= have.size(); end += card_size) {
      const std::string_view card = have.substr(end, card_size);
      const std::string_view key = keyword_of(card);
      ended = is_end(card);
      if (card[8] == '=' &&
          (key.starts_with("NAXIS") || key == "BITPIX" || key == "PCOUNT" || key == "GCOUNT"))
        scan.count(key, std::strtod(std::string(value_of(card)).c_str(), nullptr));
    }
    if (!ended) return end - at > longest_header ? have.size() : 2 * have.size();
    const auto data = scan.data_bytes();
    if (!data) return have.size();
    at = padded(padded(end) + *data);
  }
  return at + block_size;
}

}  // namespace

HarmlessFits::HarmlessFits(std::string_view bytes, const std::string& name) : given_(bytes) {
  const auto change = [&](std::size_t at, std::string_view text) {
    if (mended_.empty()) mended_ = given_;
    if (mended_.size() < at + text.size()) mended_.resize(at + text.size(), '\0');
    mended_.replace(at, text.size(), text);
  };
  std::vector<std::string> unprintable, too_long;
  std::size_t at = 0;
  bool has_data = false;
  while (at + card_size <= bytes.size()) {
    if (at > 0 && !bytes.substr(at).starts_with("XTENSION")) break;  // not an HDU
    HeaderScan scan;
    bool ended = false;
    std::size_t end = at;
    for (; !ended && end + card_size <= bytes.size(); end += card_size) {
      std::string card(bytes.substr(end, card_size));
      ended = is_end(card);
      if (ended) {
        const std::string last = "END" + std::string(card_size - 3, ' ');
        if (card != last) change(end, last);
        continue;
      }
      if (!std::all_of(card.begin(), card.end(), is_printable)) {
        for (char& c : card)
          if (!is_printable(c)) c = c >= 0 && c < ' ' ? ' ' : '?';
        const std::string_view key = keyword_of(card);
        unprintable.push_back(key.empty() ? "card " + std::to_string((end - at) / card_size + 1)
                                          : std::string(key));
        change(end, card);
      }
      if (const std::string shorter = scan.take(card, name); !shorter.empty()) {
        too_long.emplace_back(keyword_of(card));
        change(end, shorter);
      }
    }
    const auto data = scan.data_bytes();
    if (!ended || !data) {  // CFITSIO takes whatever is in memory for sizes that it can't read
      if (ended && !has_data) throw ConfigError(name + ": NAXIS: says more data than a file holds");
      asked_ = at == 0 ? end : at;  // a later HDU without an end or a size is left out
      break;
    }
    has_data = has_data || *data > 0;
    if (padded(end) > bytes.size()) change(end, std::string(padded(end) - end, ' '));
    const std::size_t data_end = padded(end) + *data;
    at = asked_ = padded(data_end);
    if (*data > 0 && data_end <= bytes.size() && at > bytes.size()) {
      change(data_end, std::string(at - data_end, '\0'));
      notes_.push_back("END: the file ends without the padding of its last block");
    }
  }
  if (at > 0 && at == asked_ && at < bytes.size()) {
    notes_.push_back("END: what follows the last HDU is no HDU, and is left out");
    if (mended_.empty())
      given_ = given_.substr(0, at);
    else
      mended_.resize(at);
  }
  if (!unprintable.empty())
    notes_.push_back(listed(unprintable) +
                     ": bytes that are not printable ASCII are read as blanks and ?");
  if (!too_long.empty()) notes_.push_back(listed(too_long) + ": a long number is rounded");
}

void require_bytes(std::string_view bytes, std::size_t asked, const std::string& name) {
  if (bytes.size() < asked)
    throw ConfigError(name + ": is truncated: " + std::to_string(bytes.size()) + " of " +
                      std::to_string(asked) + " bytes");
}

std::string read_fits_file(const std::string& path) {
  return read_file_as_needed(path, bytes_needed);
}

}  // namespace dmise
