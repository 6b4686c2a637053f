#include "core/ingest/standard_cards.h"

#include <cmath>
#include <vector>

#include "core/base/error.h"
#include "core/base/text_fields.h"
#include "core/products/observation.h"

namespace dmise {
namespace {

std::optional<double> parsed(std::string text) {
  for (char& c : text)
    if (c == 'D' || c == 'd') c = 'E';  // FITS allows the exponent of a double to be marked D
  return parse_real(text);
}

/// Parts between blanks and colons.
std::vector<std::string> parts_of(const std::string& text) {
  std::vector<std::string> parts;
  bool open = false;
  for (const char c : text) {
    if (c == ' ' || c == ':') {
      open = false;
      continue;
    }
    if (!open) parts.emplace_back();
    parts.back() += c;
    open = true;
  }
  return parts;
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
  const std::string value = text(key);
  const auto parts = parts_of(value);
  if (parts.empty()) return std::nullopt;
  if (parts.size() == 1) return number(key);
  double sum = 0.0, unit = 1.0;
  for (std::size_t i = 0; i < parts.size(); ++i, unit /= 60) {
    const auto part = parsed(parts[i]);
    if (!part || parts.size() > 3 || (i > 0 && !(*part >= 0 && *part < 60))) {
      reject(key, "is not an angle");
      return std::nullopt;
    }
    sum += std::abs(*part) * unit;
  }
  return (parts.front().starts_with('-') ? -sum : sum) * (hours ? 15.0 : 1.0);
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
