#include "core/ingest/standard_cards.h"

#include <cmath>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/base/files/text_fields.h"
#include "core/products/observation.h"

namespace dmise {
namespace {

std::optional<double> parsed(std::string text) {
  for (char& c : text)
    if (c == 'D' || c == 'd') c = 'E';  // FITS allows the exponent of a double to be marked D
  return parse_real(text);
}

/// Parts between blanks, colons and the signs of units, as in 12h30m36s or 33d46'12". A letter
/// after a digit separates only if the text is no number (1D1 is one).
std::vector<std::string> parts_of(const std::string& text) {
  const std::string_view separators = parsed(text) ? " :" : " :?'\"dhmsDHMS";
  std::vector<std::string> parts;
  bool open = false;
  for (const char c : text) {
    if (separators.find(c) != std::string_view::npos) {
      open = false;
      continue;
    }
    if (!open) parts.emplace_back();
    parts.back() += c;
    open = true;
  }
  return parts;
}

/// Takes N, S, E or W from the end of an angle; -1 for S and W.
double taken_side(std::string& text) {
  if (text.size() < 2 || std::string_view("NSEWnsew").find(text.back()) == std::string_view::npos)
    return 1.0;
  // "12h30m36s" ends with seconds, not in the south.
  if (text.back() == 's' && text.find_first_of("hmHM") != std::string::npos) return 1.0;
  const bool negative = std::string_view("SWsw").find(text.back()) != std::string_view::npos;
  text.pop_back();
  return negative ? -1.0 : 1.0;
}

}  // namespace

std::string StandardCards::text(const std::string& key) const {
  read_.insert(key);
  const auto at = values_.find(key);
  return at == values_.end() ? "" : header_text(at->second);
}

std::optional<double> StandardCards::number(const std::string& key) const {
  if (text(key).empty()) return std::nullopt;
  const auto value = parsed(text(key));
  if (!value) reject(key, "is not a finite number");
  return value;
}

std::optional<StandardCards::Named<double>> StandardCards::first_number(
    std::initializer_list<const char*> keys) const {
  for (const char* key : keys)
    if (const auto value = number(key)) return Named<double>{key, *value};
  return std::nullopt;
}

std::optional<StandardCards::Named<std::string>> StandardCards::first_text(
    std::initializer_list<const char*> keys) const {
  for (const char* key : keys)
    if (const std::string value = text(key); !value.empty()) return Named<std::string>{key, value};
  return std::nullopt;
}

std::optional<double> StandardCards::angle_deg(const std::string& key, bool hours) const {
  std::string value = text(key);
  const double side = taken_side(value);
  auto parts = parts_of(value);
  if (parts.empty()) return std::nullopt;
  const auto refuse = [&] {
    reject(key, parts.size() == 1 ? "is not a finite number" : "is not an angle");
    return std::nullopt;
  };
  if (parts.size() == 4 && parts[3].size() <= 2 && parts[2].find('.') == std::string::npos) {
    parts[2] += (parts[3].size() == 1 ? ".0" : ".") + parts[3];
    parts.pop_back();
    assumed(key + ": its fourth part is taken for hundredths of a second");
  }
  if (parts.size() > 3) return refuse();
  double sum = 0.0, unit = 1.0;
  for (std::size_t i = 0; i < parts.size(); ++i, unit /= 60) {
    const auto part = parsed(parts[i]);
    if (!part || (i > 0 && !(*part >= 0 && *part < 60))) return refuse();
    sum += std::abs(*part) * unit;
  }
  const double sign = parts.front().starts_with('-') ? -side : side;
  return sign * sum * (hours && parts.size() > 1 ? 15.0 : 1.0);
}

void StandardCards::reject(const std::string& key, const std::string& reason) const {
  rejected_[key] = reason + ", got " + text(key);
  missing(key + ": " + rejected_[key]);
}

void StandardCards::require_accepted(const std::string& key, const std::string& name) const {
  if (const auto at = rejected_.find(key); at != rejected_.end())
    throw ConfigError(name + ": " + key + ": " + at->second);
}

}  // namespace dmise
