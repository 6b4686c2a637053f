#include "sensors/indi/indi_request.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/base/files/text_fields.h"
#include "core/base/printable.h"

namespace dmise {
namespace {

constexpr std::array kind_names{
    std::pair{IndiKind::text, "Text"}, std::pair{IndiKind::number, "Number"},
    std::pair{IndiKind::toggle, "Switch"}, std::pair{IndiKind::light, "Light"},
    std::pair{IndiKind::blob, "BLOB"}};

std::string needed(const IndiElement& element, const char* key) {
  const std::string value = element.attribute(key);
  if (value.empty())
    throw BadIndi(printable(element.name, 60) + ": the attribute " + key + " is missing");
  return value;
}

BlobUse blob_use(const IndiElement& element) {
  if (element.text == "Never") return BlobUse::never;
  if (element.text == "Also") return BlobUse::also;
  if (element.text == "Only") return BlobUse::only;
  throw BadIndi("enableBLOB: must be Never, Also or Only, got " + printable(element.text, 60));
}

NewIndiVector new_vector(const IndiElement& element, IndiKind kind) {
  NewIndiVector vector{kind, needed(element, "device"), needed(element, "name"), {}};
  const std::string one = "one" + std::string(name_of(kind));
  for (const IndiElement& part : element.parts) {
    if (part.name != one)
      throw BadIndi(element.name + ": must have " + one + ", got " + printable(part.name, 60));
    vector.values[needed(part, "name")] = part.text;
  }
  return vector;
}

/// A part of a sexagesimal number, without a sign.
std::optional<double> part_of(std::string_view text) {
  return text.front() == '-' || text.front() == '+' ? std::nullopt : parse_real(text);
}

}  // namespace

std::string_view name_of(IndiKind kind) {
  for (const auto& [known, name] : kind_names)
    if (known == kind) return name;
  return {};
}

std::optional<IndiRequest> parse_indi(const IndiElement& element) {
  if (element.name == "getProperties")
    return GetIndiProperties{element.attribute("device"), element.attribute("name")};
  if (element.name == "enableBLOB")
    return EnableIndiBlob{needed(element, "device"), element.attribute("name"), blob_use(element)};
  for (const auto& [kind, name] : kind_names)
    if (element.name == "new" + std::string(name) + "Vector") return new_vector(element, kind);
  return std::nullopt;
}

std::optional<double> indi_number(std::string_view text) {
  text = trimmed(text);
  const bool negative = text.starts_with('-');
  if (negative || text.starts_with('+')) text.remove_prefix(1);
  double sum = 0.0, unit = 1.0;
  for (int parts = 0; parts == 0 || !text.empty(); ++parts) {
    if (parts == 3) return std::nullopt;
    const auto end = std::min(text.find_first_of(" :;"), text.size());
    const auto part = end == 0 ? std::nullopt : part_of(text.substr(0, end));
    if (!part) return std::nullopt;
    sum += *part / unit;
    unit *= 60.0;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  if (!std::isfinite(sum)) return std::nullopt;
  return negative ? -sum : sum;
}

}  // namespace dmise
